// SPDX-License-Identifier: Apache-2.0
#include "row_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace armature::report::joints {
namespace {

std::string cannot_write(const std::filesystem::path& file, const std::string& reason) {
  return fmt::format("cannot write '{}': {}", file.string(), reason);
}

}  // namespace

void remove_older(const std::filesystem::path& file) {
  std::error_code error;
  const auto there = std::filesystem::symlink_status(file, error);
  if (!std::filesystem::exists(there)) return;
  if (!std::filesystem::is_regular_file(there) && !std::filesystem::is_symlink(there)) {
    throw std::runtime_error{cannot_write(file, "it is no regular file")};
  }
  std::filesystem::remove(file, error);
  if (error) throw std::runtime_error{cannot_write(file, error.message())};
}

RowFile::RowFile(std::filesystem::path file) : file_{std::move(file)} {
  remove_older(file_);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (descriptor_ < 0) throw std::runtime_error{cannot_write(file_, std::strerror(errno))};
}

RowFile::~RowFile() { ::close(descriptor_); }

void RowFile::append(std::string_view lines) {
  if (!trouble_.empty()) return;
  std::string_view left = lines;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written > 0) left.remove_prefix(static_cast<std::size_t>(written));
    if (written > 0 || (written < 0 && errno == EINTR)) continue;
    return refuse(written == 0 ? ENOSPC : errno);
  }
  size_ += static_cast<std::int64_t>(lines.size());
}

void RowFile::sync() {
  if (trouble_.empty() && ::fsync(descriptor_) != 0) refuse(errno);
}

/// What was half written is taken back.
void RowFile::refuse(int error) {
  trouble_ = cannot_write(file_, std::strerror(error));
  if (::ftruncate(descriptor_, size_) != 0) {
    trouble_ += fmt::format("; its last line may be cut ({})", std::strerror(errno));
  }
}

}  // namespace armature::report::joints
