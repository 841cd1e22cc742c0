// SPDX-License-Identifier: Apache-2.0
#include "record/destination.hpp"

#include <system_error>
#include <utility>

namespace armature {
namespace {

/// Also a link that leads nowhere.
bool is_there(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::exists(std::filesystem::symlink_status(file, none));
}

}  // namespace

Destination::Destination(std::filesystem::path file, bool force)
    : file_{std::move(file)}, was_there_{is_there(file_)}, older_{hold_to_replace(file_, force)} {
  if (older_) draft_.emplace(file_, "recording");
}

Destination::~Destination() {
  if (draft_) draft_->keep();
}

void Destination::drop() {
  std::error_code none;
  if (draft_) {
    draft_.reset();
  } else if (!was_there_) {
    std::filesystem::remove(file_, none);
  } else if (std::filesystem::is_regular_file(file_, none)) {  // it was empty
    std::filesystem::resize_file(file_, 0, none);
  }
}

void Destination::take() {
  if (!draft_) return;
  draft_->give_name();
  draft_.reset();
}

}  // namespace armature
