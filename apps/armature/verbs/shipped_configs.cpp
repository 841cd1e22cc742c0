// SPDX-License-Identifier: Apache-2.0
#include "verbs/shipped_configs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "armature/config/problems.hpp"
#include "exit_code.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// The YAML files of a folder, sorted.
std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{folder, error}) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

fs::path shipped_folder(const std::string& name) {
  const auto prefix = fs::canonical("/proc/self/exe").parent_path().parent_path();
  return prefix / "share" / "armature" / name;
}

std::vector<fs::path> shipped_deployments() { return yaml_files(shipped_config_folder()); }

std::vector<fs::path> shipped_robots() { return yaml_files(shipped_config_folder() / "robots"); }

std::string deployment_file(const std::string& given) {
  std::error_code none;  // a name may be too long for a file, or a link lead to itself
  const auto there = fs::status(given, none);
  const bool is_file = fs::exists(there) && !fs::is_directory(there);
  if (is_file || given.find_first_of("./=") != std::string::npos) return given;
  std::vector<std::string> names;
  for (const fs::path& file : shipped_deployments()) {
    if (file.stem() == given) return file;
    names.push_back(file.stem());
  }
  throw InvalidChoice(
      fmt::format("there is no file {0} here, and no deployment {0} came with armature{1}",
                  config::in_quotes(given), config::did_you_mean(given, names)));
}

}  // namespace armature
