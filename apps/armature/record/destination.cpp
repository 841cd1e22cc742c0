// SPDX-License-Identifier: Apache-2.0
#include "record/destination.hpp"

#include <utility>

namespace armature {

Destination::Destination(std::filesystem::path file, bool force)
    : file_{std::move(file)}, older_{hold_to_replace(file_, force)} {
  if (older_) draft_.emplace(file_, "recording");
}

Destination::~Destination() {
  if (draft_) draft_->keep();
}

void Destination::take() {
  if (!draft_) return;
  draft_->give_name();
  draft_.reset();
}

}  // namespace armature
