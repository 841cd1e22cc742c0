// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/file_lock.hpp"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>

namespace armature {

void lock_for_writing(int descriptor, const std::filesystem::path& file) {
  struct stat about {};
  if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) return;
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  throw std::runtime_error(fmt::format("'{}' is being written by another program", file.string()));
}

}  // namespace armature
