// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/write_atomically.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace armature {
namespace {

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(file) == 0;
}

}  // namespace

void write_atomically(const std::filesystem::path& target, std::string_view text, FileUse use) {
  const bool is_report = use == FileUse::report;
  std::error_code none;
  const auto file = !is_report && std::filesystem::is_symlink(target, none)
                        ? std::filesystem::weakly_canonical(target, none)
                        : target;
  // A device or a pipe must not become a file, not even one that a link points to.
  if (std::filesystem::exists(file, none) && !std::filesystem::is_regular_file(file, none)) {
    throw std::runtime_error{
        fmt::format("cannot write '{}': it is no regular file", file.string())};
  }
  const std::string beside = fmt::format("{}.{}", file.string(), getpid());
  const auto failed = [&](int error) {
    unlink(beside.c_str());
    return std::runtime_error{
        fmt::format("cannot write '{}': {}", file.string(), std::strerror(error))};
  };
  const int descriptor = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                              use == FileUse::named_by_user ? 0666 : 0600);
  if (descriptor < 0) throw failed(errno);
  const bool written = write_all(descriptor, text);
  const int error = errno;
  close(descriptor);
  if (!written) throw failed(error);
  if (std::rename(beside.c_str(), file.c_str()) != 0) throw failed(errno);
}

}  // namespace armature
