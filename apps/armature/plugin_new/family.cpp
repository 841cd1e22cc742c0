// SPDX-License-Identifier: Apache-2.0
#include "plugin_new/family.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/source_text.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

std::vector<std::string> texts_of(const config::Node* list, config::Problems& problems) {
  std::vector<std::string> texts;
  if (!list) return texts;
  for (const config::Node& item : list->items()) {
    texts.push_back(config::as_text(item, problems).value_or(""));
  }
  return texts;
}

}  // namespace

std::filesystem::path template_folder() {
  return shipped_config_folder().parent_path() / "templates";
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{template_folder()}) {
    if (exists(entry.path() / "family.yaml")) names.push_back(entry.path().filename());
  }
  std::ranges::sort(names);
  return names;
}

PluginFamily read_family(const std::string& name,
                         const std::function<std::string(std::string)>& fill) {
  const std::filesystem::path file = template_folder() / name / "family.yaml";
  config::Problems problems;
  const config::Node document =
      config::parse_text(fill(config::read_source(file, {})), file.string());
  config::MapReader map{document, "family '" + name + "'", problems};
  PluginFamily family{.doc = map.text("doc"),
                      .links = texts_of(map.node("link"), problems),
                      .robot = map.flag("robot", false),
                      .runs = texts_of(map.node("run"), problems),
                      .files = {}};
  if (const config::Node* files = map.optional_node("files")) {
    for (const auto& [key, origin, value] : files->entries()) {
      family.files.emplace_back(key, config::as_text(value, problems).value_or(""));
    }
  }
  map.finish();
  problems.throw_if_any();
  return family;
}

std::string family_table() {
  std::string table = "Families:\n";
  for (const std::string& name : family_names()) {
    const PluginFamily family = read_family(name, [](std::string text) { return text; });
    table += fmt::format("  {:<13} {}\n", name + "/...", family.doc);
  }
  return table;
}

}  // namespace armature
