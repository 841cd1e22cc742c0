// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace armature::ik::process {
namespace {

namespace fs = std::filesystem;

bool can_be_executed(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0;
}

}  // namespace

std::string Command::text() const {
  constexpr std::size_t kLength = 60;
  std::string all;
  for (const std::string& word : words) all.append(all.empty() ? "" : " ").append(word);
  if (all.size() > kLength) all.replace(kLength, std::string::npos, "...");
  return all;
}

Expected<Command> find_command(std::vector<std::string> words, std::string folder) {
  if (words.empty() || words.front().empty()) {
    return refuse("'command' is empty: it lists the program and its arguments");
  }
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error)) {
    return refuse(fmt::format("there is no folder '{}'", folder));
  }
  const std::string& name = words.front();
  if (name.find('/') != std::string::npos) {
    const fs::path file = fs::absolute(fs::path{folder} / name).lexically_normal();
    if (!fs::exists(file, error)) return refuse(fmt::format("there is no '{}'", file.string()));
    if (!can_be_executed(file)) {
      return refuse(fmt::format("'{}' cannot be executed", file.string()));
    }
    return Command{std::move(words), file.string(), std::move(folder)};
  }
  const char* path = std::getenv("PATH");
  std::istringstream places{path ? path : ""};
  for (std::string place; std::getline(places, place, ':');) {
    const fs::path file = fs::path{place} / name;
    if (can_be_executed(file))
      return Command{std::move(words), fs::absolute(file).string(), std::move(folder)};
  }
  return refuse(
      fmt::format("there is no program '{}' in PATH, which is {}", name, path ? path : "not set"));
}

}  // namespace armature::ik::process
