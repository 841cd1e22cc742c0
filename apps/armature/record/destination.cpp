// SPDX-License-Identifier: Apache-2.0
#include "record/destination.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "armature/recording/file_lock.hpp"
#include "record/record.hpp"

namespace armature {

Destination::Destination(std::filesystem::path file, bool force) : file_{std::move(file)} {
  refuse_to_replace(file_, force);
  std::error_code none;
  if (!std::filesystem::is_regular_file(file_, none)) return;
  if (std::filesystem::file_size(file_, none) == 0) return;
  older_.reset(std::fopen(file_.c_str(), "re"));
  if (!older_) {
    throw std::runtime_error(fmt::format("cannot replace '{}': {}", file_.string(),
                                         std::generic_category().message(errno)));
  }
  lock_for_writing(fileno(older_.get()), file_);
  draft_.emplace(file_, "recording");
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
