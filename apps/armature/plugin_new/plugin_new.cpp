// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

void replace_all(std::string& text, std::string_view mark, std::string_view value) {
  for (auto at = text.find(mark); at != std::string::npos;
       at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
}

std::string class_name(std::string_view name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') result += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return result;
}

/// lib/cmake/Armature of the installation, or the build folder, that this program belongs to.
fs::path package_folder() {
  const fs::path program = fs::canonical("/proc/self/exe");
  const fs::path prefix = program.parent_path().parent_path();
  return fs::exists(prefix / "ArmatureConfig.cmake") ? prefix
                                                     : prefix / "lib" / "cmake" / "Armature";
}

/// The folders of templates that came with this program, one per family.
fs::path template_folder() { return shipped_config_folder().parent_path() / "templates"; }

std::vector<std::string> families() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator{template_folder()}) {
    names.push_back(entry.path().filename());
  }
  std::ranges::sort(names);
  return names;
}

/// The template for plugins of `family`.
fs::path template_for(const std::string& family) {
  const std::vector<std::string> known = families();
  if (std::ranges::find(known, family) != known.end()) return template_folder() / family;
  throw InvalidChoice(fmt::format(
      "there is no template for '{}/...', only for '{}/...'; begin with a copy of such a plugin, "
      "see plugins/ in the sources",
      family, fmt::join(known, "/...', '")));
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
      fmt::format("'{}' must be '{}/name', the name in lower case letters, digits and '_'", text,
                  fmt::join(families(), "/name', '")));
}

}  // namespace

int new_plugin(const std::string& text, const fs::path& directory) {
  const PluginId id = id_from(text);
  const fs::path from = template_for(id.family);
  const PluginRegistry plugins;
  if (const PluginManifest* there = plugins.find(id.text)) {
    throw InvalidChoice(fmt::format("there is a plugin '{}' already, '{}'; choose another name",
                                    id.text, there->file.string()));
  }
  if (fs::exists(directory) && !fs::is_empty(directory)) {
    throw InvalidChoice(fmt::format("'{}' is there already and not empty", directory.string()));
  }
  prepare_output_folder(directory);
  const auto fill = [&](std::string filled) {
    replace_all(filled, "@ID@", id.text);
    replace_all(filled, "@NAME@", id.name);
    replace_all(filled, "@CLASS@", class_name(id.name));
    replace_all(filled, "@TARGET@", id.family + '_' + id.name);
    replace_all(filled, "@NAMESPACE@", fmt::format("armature::{}::{}", id.family, id.name));
    replace_all(filled, "@PACKAGE@", package_folder().string());
    replace_all(filled, "@CONFIGS@", shipped_config_folder().string());
    return filled;
  };
  for (const auto& entry : fs::directory_iterator{from}) {
    const std::string name = fill(entry.path().filename());
    write_atomically(directory / name, fill(text_of(entry.path())), FileUse::named_by_user);
  }
  fs::copy_file(shipped_config_folder() / "robots" / "arm.urdf", directory / "arm.urdf");
  fmt::print("wrote {}: see {}\n", id.text, (directory / "README.md").string());
  return kOk;
}

}  // namespace armature
