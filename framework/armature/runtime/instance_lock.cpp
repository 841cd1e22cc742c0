// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/instance_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace armature {
namespace {

std::filesystem::path lock_folder() {
  if (const char* runtime = std::getenv("XDG_RUNTIME_DIR")) {
    return std::filesystem::path{runtime} / "armature";
  }
  return std::filesystem::temp_directory_path() / fmt::format("armature-{}", getuid());
}

std::string holder_of(int file) {
  std::array<char, 64> text{};
  const auto size = pread(file, text.data(), text.size() - 1, 0);
  return size > 0 ? std::string{text.data()} : "?";
}

}  // namespace

Expected<InstanceLock> InstanceLock::take(const std::string& deployment, int domain) {
  const auto folder = lock_folder();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto path = folder / fmt::format("{}-domain{}.lock", deployment, domain);
  // Close-on-exec: a child process must not keep the lock of a parent that was killed.
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0) {
    return refuse(fmt::format("cannot open {}: {}", path.string(), std::strerror(errno)));
  }
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    const std::string holder = holder_of(file);
    close(file);
    return refuse(
        fmt::format("deployment '{}' already runs as pid {} on domain {}; stop it, or use "
                    "another domain with --domain",
                    deployment, holder, domain));
  }
  const std::string pid = std::to_string(getpid());
  if (ftruncate(file, 0) != 0 || pwrite(file, pid.data(), pid.size(), 0) < 0) {
    const std::string reason = std::strerror(errno);
    close(file);
    return refuse(fmt::format("cannot write {}: {}", path.string(), reason));
  }
  return InstanceLock{file};
}

InstanceLock::InstanceLock(InstanceLock&& other) noexcept : file_{std::exchange(other.file_, -1)} {}

InstanceLock::~InstanceLock() {
  if (file_ >= 0) close(file_);
}

}  // namespace armature
