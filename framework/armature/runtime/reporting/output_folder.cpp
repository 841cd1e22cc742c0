// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/output_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace armature {

namespace {

/// Throws at the first link of another user among the parts of the path.
void refuse_links_of_others(const std::filesystem::path& folder) {
  std::filesystem::path place;
  for (const auto& part : folder) {
    if (part.empty()) continue;  // a slash at the end
    place /= part;
    struct stat status {};
    if (lstat(place.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) continue;
    if (status.st_uid == geteuid() || status.st_uid == 0) continue;
    throw std::runtime_error{
        fmt::format("cannot write into '{}': it is a link of user {}; name the folder that it "
                    "leads to",
                    place.string(), status.st_uid)};
  }
}

}  // namespace

void prepare_output_folder(const std::filesystem::path& folder) {
  refuse_links_of_others(folder);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error{
        fmt::format("cannot make the folder '{}': {}", folder.string(), error.message())};
  }
  std::string trial = (folder / ".armature-XXXXXX").string();
  const int file = mkstemp(trial.data());
  if (file < 0) {
    throw std::runtime_error{
        fmt::format("cannot write into '{}': {}", folder.string(), std::strerror(errno))};
  }
  close(file);
  unlink(trial.c_str());
}

}  // namespace armature
