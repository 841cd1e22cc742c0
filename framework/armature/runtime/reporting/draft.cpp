// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/draft.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <random>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace armature {

Draft::Draft(std::filesystem::path named, std::string_view purpose, mode_t mode, Link link)
    : named_{std::move(named)} {
  constexpr int kTries = 100;
  std::error_code none, error;
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("cannot write '{}': {}", named_.string(), why));
  };
  if (link == Link::keeps_pointing && std::filesystem::is_symlink(named_, none)) {
    auto pointed_at = std::filesystem::weakly_canonical(named_, error);
    if (error) refuse(error.message());  // a link that leads to itself
    named_ = std::move(pointed_at);
  }
  if (std::filesystem::exists(named_, none) && !std::filesystem::is_regular_file(named_, none)) {
    refuse("it is no regular file");
  }
  std::random_device lot;
  for (int i = 0; i < kTries; ++i) {
    path_ = fmt::format("{}.{}-{:06x}", named_.string(), purpose, lot() & 0xFFFFFFU);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  refuse(std::generic_category().message(errno));
}

Draft::~Draft() {
  close_file();
  std::error_code none;
  if (!path_.empty()) std::filesystem::remove(path_, none);
}

void Draft::give_name() {
  close_file();
  std::filesystem::rename(path_, named_);
  path_.clear();
}

void Draft::keep() {
  close_file();
  path_.clear();
}

void Draft::close_file() {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
}

}  // namespace armature
