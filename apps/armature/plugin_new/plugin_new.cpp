// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/parameters/cpp_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/file_content.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "plugin_new/family.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, std::string_view mark, std::string_view value) {
  for (auto at = text.find(mark); at != std::string::npos;
       at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
}

/// Whether `text` names `word`.
bool names(std::string_view text, std::string_view word) {
  for (auto at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const bool begins = at == 0 || !is_in_a_name(text[at - 1]);
    const auto end = at + word.size();
    if (begins && (end == text.size() || !is_in_a_name(text[end]))) return true;
  }
  return false;
}

/// The class of a plugin: "my_solver" is MySolver, unless its template means another class by that.
std::string class_name(std::string_view name, std::string_view source) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return names(source, result) ? result + "Plugin" : result;
}

/// lib/cmake/Armature of the installation, or the build folder, that this program belongs to.
fs::path package_folder() {
  const fs::path program = fs::canonical("/proc/self/exe");
  const fs::path prefix = program.parent_path().parent_path();
  return fs::exists(prefix / "ArmatureConfig.cmake") ? prefix
                                                     : prefix / "lib" / "cmake" / "Armature";
}

/// Throws unless there is a template for plugins of `family`.
void check_family(const std::string& family) {
  const std::vector<std::string> known = family_names();
  if (std::ranges::find(known, family) != known.end()) return;
  throw InvalidChoice(
      fmt::format("there is no family of plugins '{}'{}; `armature plugin new --help` lists all",
                  family, config::did_you_mean(family, known)));
}

struct PluginId {
  std::string text, family, name;  // "ik/mine", "ik", "mine"
};

PluginId id_from(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  PluginId id{text, text.substr(0, slash), text.substr(std::min(slash + 1, text.size()))};
  const auto in_a_name = [](unsigned char c) {
    return std::islower(c) || std::isdigit(c) || c == '_';
  };
  if (!id.name.empty() && std::islower(static_cast<unsigned char>(id.name.front())) &&
      std::ranges::all_of(id.name, in_a_name)) {
    return id;
  }
  throw InvalidChoice(
      fmt::format("'{}' must be 'family/name', the name in lower case letters, digits and '_'; "
                  "`armature plugin new --help` lists the families",
                  text));
}

/// The texts that take the place of a template's marks, by @MARK@. `source`: the plugin's file of
/// the template.
class Marks {
 public:
  Marks(const PluginId& id, std::string_view source)
      : marks_{{"@ID@", id.text},
               {"@NAME@", id.name},
               {"@CLASS@", class_name(id.name, source)},
               {"@TARGET@", id.family + '_' + id.name},
               {"@NAMESPACE@", namespace_of(id.text)},
               {"@PACKAGE@", package_folder().string()}} {}

  void add(const std::string& mark, std::string text) {
    marks_.emplace_back(mark, std::move(text));
  }
  std::string fill(std::string text) const {
    for (const auto& [mark, value] : marks_) replace_all(text, mark, value);
    return text;
  }

 private:
  std::vector<std::pair<std::string, std::string>> marks_;
};

/// Adds what the files that all families share say differently of each.
void add_shared_marks(const PluginFamily& family, const fs::path& from, Marks& marks) {
  const config::Node manifest =
      config::parse_text(marks.fill(content_of(from / "plugin.yaml")), "");
  marks.add("@DOC@", manifest.find("doc")->text());
  marks.add("@LINK@", fmt::format("Armature::{}", fmt::join(family.links, " Armature::")));
  const bool has_test = fs::exists(from / "@NAME@_test.cpp");
  marks.add("@TESTS@", has_test ? marks.fill(" TESTS @NAME@_test.cpp") : "");
  marks.add("@ROBOT@", family.robot ? " --robot arm.yaml" : "");
  std::string runs, files;
  for (const std::string& run : family.runs) runs += "    " + run + '\n';
  for (const auto& [file, says] : family.files) files += fmt::format("| `{}` | {} |\n", file, says);
  if (family.robot) {
    files += "| `arm.yaml`, `arm.urdf` | a robot to try it with: put your own here |\n";
  }
  marks.add("@RUN@\n", runs + '\n');
  marks.add("@FILES@\n", files + '\n');
}

}  // namespace

int new_plugin(const std::string& text, const fs::path& directory) {
  const PluginId id = id_from(text);
  check_family(id.family);
  const PluginRegistry plugins;
  if (const PluginManifest* there = plugins.find(id.text)) {
    throw InvalidChoice(fmt::format("there is a plugin '{}' already, '{}'; choose another name",
                                    id.text, there->file.string()));
  }
  if (fs::exists(directory) && !fs::is_empty(directory)) {
    throw InvalidChoice(fmt::format("'{}' is there already and not empty", directory.string()));
  }
  prepare_output_folder(directory);
  const fs::path from = template_folder() / id.family, common = template_folder() / "common";
  Marks marks{id, content_of(from / "@NAME@.cpp")};
  const PluginFamily family =
      read_family(id.family, [&](std::string filled) { return marks.fill(std::move(filled)); });
  add_shared_marks(family, from, marks);
  const auto write = [&](const fs::path& file) {
    const fs::path written = directory / marks.fill(file.filename());
    write_atomically(written, marks.fill(content_of(file)), FileUse::named_by_user);
  };
  for (const auto& entry : fs::directory_iterator{from}) {
    if (entry.path().filename() != "family.yaml") write(entry.path());
  }
  for (const char* file : {"CMakeLists.txt", "README.md"}) write(common / file);
  if (family.robot) {
    write(common / "arm.yaml");
    write(shipped_config_folder() / "robots" / "arm.urdf");
  }
  print_out("wrote {}: see {}\n", id.text, (directory / "README.md").string());
  return kOk;
}

}  // namespace armature
