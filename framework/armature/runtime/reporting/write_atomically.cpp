// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/write_atomically.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "armature/runtime/reporting/draft.hpp"

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

/// The folder would let it be replaced.
bool is_write_protected(const std::filesystem::path& file) {
  using std::filesystem::perms;
  std::error_code none;
  const auto status = std::filesystem::status(file, none);
  constexpr perms kWrite = perms::owner_write | perms::group_write | perms::others_write;
  return std::filesystem::is_regular_file(status) && (status.permissions() & kWrite) == perms::none;
}

}  // namespace

void refuse_write_protected(const std::filesystem::path& file) {
  if (!is_write_protected(file)) return;
  throw std::runtime_error{fmt::format(
      "cannot write '{}': it is write-protected; chmod u+w lets it be replaced", file.string())};
}

void write_atomically(const std::filesystem::path& file, std::string_view text, FileUse use) {
  if (use == FileUse::named_by_user) refuse_write_protected(file);
  Draft draft{file, "draft", use == FileUse::named_by_user ? mode_t{0666} : mode_t{0600},
              use == FileUse::report ? Draft::Link::is_replaced : Draft::Link::keeps_pointing};
  if (!write_all(draft.descriptor(), text)) {
    throw std::runtime_error{
        fmt::format("cannot write '{}': {}", file.string(), std::strerror(errno))};
  }
  try {
    draft.give_name();
  } catch (const std::filesystem::filesystem_error& error) {
    throw std::runtime_error{
        fmt::format("cannot write '{}': {}", file.string(), error.code().message())};
  }
}

}  // namespace armature
