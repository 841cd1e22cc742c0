// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "armature/messages/generator/message_code.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

struct Included {
  int line;
  std::string name;
};

/// Of `#include "a.idl"` or <a.idl>; nullopt: the line is something else.
std::optional<std::string> included_by(const std::string& line) {
  std::istringstream words{line};
  char sign = 0;
  std::string word, name;
  if (!(words >> sign >> word) || sign != '#' || !word.starts_with("include")) return std::nullopt;
  const std::size_t open = line.find_first_of("\"<");
  if (open == std::string::npos) return std::nullopt;
  const std::size_t close = line.find_first_of("\">", open + 1);
  if (close == std::string::npos) return std::nullopt;
  return line.substr(open + 1, close - open - 1);
}

std::vector<Included> includes_of(const std::string& idl) {
  std::vector<Included> includes;
  std::istringstream lines{idl};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (auto name = included_by(line)) includes.push_back({number, std::move(*name)});
  }
  return includes;
}

/// A type is named "package::msg::dds_::Type_", as ROS 2 names its own on DDS: under another name
/// nobody finds it.
Expected<void> check_scope(const fs::path& file, const std::string& name) {
  constexpr std::string_view kBetween = "::msg::dds_::";
  const std::size_t at = name.find(kBetween);
  if (at != std::string::npos && at > 0 && name.find("::") == at &&
      name.find("::", at + kBetween.size()) == std::string::npos) {
    return {};
  }
  return refuse(
      file.string() + ": " + name +
      " must stand in 'module PACKAGE { module msg { module dds_ {', as messages of ROS 2 "
      "do on DDS");
}

}  // namespace

bool IdlFiles::was_read(const fs::path& path) const {
  return std::ranges::any_of(begun_,
                             [&](const fs::path& other) { return fs::equivalent(other, path); });
}

Expected<std::string> IdlFiles::include(const std::string& name, const IdlFolder& beside) {
  std::vector<IdlFolder> folders{beside};
  folders.insert(folders.end(), folders_.begin(), folders_.end());
  std::string searched;
  for (const auto& [folder, header_folder] : folders) {
    searched += (searched.empty() ? "" : ", ") + folder.string();
    if (!fs::exists(folder / name)) continue;
    if (const auto done = read(folder / name, header_folder); !done) {
      return tl::unexpected{done.error()};
    }
    return header_folder + "/" + fs::path{name}.stem().string() + ".hpp";
  }
  return refuse("no '" + name + "' in " + searched);
}

Expected<void> IdlFiles::read(const fs::path& path) { return read(path, header_folder_); }

Expected<void> IdlFiles::read(const fs::path& path, const std::string& header_folder) {
  std::ifstream stream{path};
  if (!stream) return refuse(path.string() + ": cannot be read");
  if (was_read(path)) return {};
  begun_.push_back(path);
  std::ostringstream text;
  text << stream.rdbuf();
  IdlFile file{.path = path,
               .header = header_folder + "/" + path.stem().string() + ".hpp",
               .text = text.str()};
  for (const Included& included : includes_of(file.text)) {
    const auto header = include(included.name, {path.parent_path(), header_folder});
    if (!header) {
      return refuse(path.string() + ":" + std::to_string(included.line) + ": " +
                    header.error().text);
    }
    file.includes.push_back(*header);
  }
  const std::size_t types = known_.all().size(), constants = known_.constants().size();
  if (const auto added = known_.add(file.text, path.string()); !added) return added;
  for (std::size_t i = types; i < known_.all().size(); ++i) {
    file.types.push_back(known_.all()[i].get());
    if (const auto good = check_scope(path, file.types.back()->dds_name); !good) return good;
  }
  for (std::size_t i = constants; i < known_.constants().size(); ++i) {
    file.constants.push_back(known_.constants()[i]);
    if (const auto good = check_scope(path, file.constants.back().name); !good) return good;
  }
  files_.push_back(std::move(file));
  return {};
}

}  // namespace armature
