// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "armature/runtime/plugins/library_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// Whoever may change this library is trusted already.
bool is_trusted(uid_t owner) {
  struct stat own {};
  const bool known = stat(library_file().c_str(), &own) == 0;
  return owner == 0 || owner == geteuid() || (known && owner == own.st_uid);
}

/// Whoever could replace something in such a folder could replace this library.
bool holds_this_library(const fs::path& folder) {
  const fs::path own = library_file();
  return std::ranges::mismatch(folder, own).in1 == folder.end();
}

/// What is wrong with one folder or file. `leads_there`: it is one above, where a sticky bit (as
/// /tmp has) keeps others from replacing what they do not own.
std::optional<std::string> danger_of(const fs::path& path, bool leads_there) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  const std::string which = leads_there ? fmt::format("'{}' above it", path.string()) : "it";
  if (!is_trusted(status.st_uid)) return fmt::format("{} belongs to user {}", which, status.st_uid);
  const bool sticky = leads_there && (status.st_mode & S_ISVTX);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0 || sticky) return std::nullopt;
  return fmt::format("others may write {} (mode {:04o})", which, status.st_mode & 07777U);
}

}  // namespace

std::optional<std::string> danger_of_place(const fs::path& path) {
  std::error_code error;
  fs::path place = fs::canonical(path, error);
  if (error) return std::nullopt;  // no plugin lies where nothing is
  if (const auto danger = danger_of(place, false)) return danger;
  while (place.has_relative_path()) {
    place = place.parent_path();
    if (holds_this_library(place)) return std::nullopt;
    if (const auto danger = danger_of(place, true)) return danger;
  }
  return std::nullopt;
}

}  // namespace armature
