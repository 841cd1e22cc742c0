// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <sstream>

#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/elf_section.hpp"
#include "armature/runtime/plugins/library_folder.hpp"
#include "armature/runtime/plugins/plugin_folder.hpp"
#include "armature/runtime/plugins/processor_level.hpp"

namespace armature {
namespace {

/// The ids of a family, "ik/", or of all: "".
std::vector<std::string> ids_of(std::string_view family, std::span<const PluginManifest> plugins) {
  std::vector<std::string> ids;
  for (const auto& plugin : plugins) {
    if (plugin.id.starts_with(family)) ids.push_back(plugin.id);
  }
  return ids;
}

}  // namespace

std::vector<std::filesystem::path> PluginRegistry::default_search_path() {
  std::vector<std::filesystem::path> path;
  if (const char* variable = std::getenv("ARMATURE_PLUGIN_PATH")) {
    std::istringstream folders{variable};
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (!folder.empty()) path.emplace_back(folder);
    }
  }
  path.push_back(library_folder() / "armature" / "plugins");
  return path;
}

PluginRegistry::PluginRegistry(std::vector<std::filesystem::path> search_path)
    : search_path_{std::move(search_path)} {
  for (const auto& folder : search_path_) scan(folder);
  sort();
}

void PluginRegistry::sort() {
  std::sort(plugins_.begin(), plugins_.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
}

void PluginRegistry::add(std::string_view plugin_yaml, const PluginEntry& entry) {
  config::Problems problems;
  PluginManifest manifest = parse_manifest(plugin_yaml, "plugin.yaml", problems);
  problems.throw_if_any();
  if (find(manifest.id)) {
    throw std::invalid_argument(fmt::format("there is a plugin '{}' already", manifest.id));
  }
  of_this_program_.emplace(manifest.id, entry);
  plugins_.push_back(std::move(manifest));
  sort();
}

bool PluginRegistry::may_load_from(const std::filesystem::path& folder) {
  const auto danger = danger_of_place(folder);
  if (!danger) return true;
  const bool refused = geteuid() == 0;
  warnings_.push_back(fmt::format(
      "plugin folder {}: {}; {}", folder.string(), *danger,
      refused ? "root loads nothing from it: make it root's own, and writable by root only"
              : "whoever that is decides what runs here: make it your own, with 'chmod go-w'"));
  return !refused;
}

bool PluginRegistry::may_load(const std::filesystem::path& file) {
  const auto danger = danger_of_place(file);
  if (!danger) return true;
  const bool refused = geteuid() == 0;
  std::error_code none;
  const std::string target = std::filesystem::is_symlink(file, none)
                                 ? ", a link to " + std::filesystem::canonical(file, none).string()
                                 : "";
  warnings_.push_back(fmt::format(
      "plugin {}{}: {}; {}", file.string(), target, *danger,
      refused ? "root does not load it: make it root's own, and writable by root only"
              : "whoever that is decides what runs here: make it your own, with 'chmod go-w'"));
  return !refused;
}

void PluginRegistry::scan(const std::filesystem::path& folder) {
  std::error_code none;
  if (!std::filesystem::is_directory(folder, none)) {
    warnings_.push_back(fmt::format("plugin folder {}: {}", folder.string(),
                                    std::filesystem::exists(folder, none)
                                        ? "it is a file; name the folder that it is in"
                                        : "there is no such folder"));
    return;
  }
  if (!may_load_from(folder)) return;
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder, error}) {
    if (entry.path().extension() == ".so" && entry.is_regular_file(none)) {
      files.push_back(entry.path());
    }
  }
  if (error) {
    warnings_.push_back(
        fmt::format("plugin folder {}: it cannot be read: {}", folder.string(), error.message()));
  }
  std::sort(files.begin(), files.end());  // the directory's own order is not reproducible
  const std::string level = processor_level();
  for (const auto& file : files) {
    const auto own = library_for(level, file);
    if (may_load(own)) add(own);
  }
}

void PluginRegistry::add(const std::filesystem::path& file) {
  const auto sections =
      read_elf_sections(file, {".armature.manifest", ".armature.abi", ".armature.idl"});
  if (!sections) {
    unusable_.push_back({file, sections.error().text});
    return;
  }
  const auto text = sections->find(".armature.manifest");
  if (const auto idl = sections->find(".armature.idl"); idl != sections->end()) {
    messages_.push_back({file, idl->second});
    if (text == sections->end()) return;
  }
  if (text == sections->end()) {
    unusable_.push_back({file, "not an Armature plugin: it has no manifest"});
    return;
  }
  config::Problems problems;
  try {
    PluginManifest manifest =
        parse_manifest(text->second, file.string() + ":plugin.yaml", problems);
    problems.throw_if_any();
    manifest.file = file;
    if (const auto abi = sections->find(".armature.abi"); abi != sections->end()) {
      manifest.abi = abi->second;
    }
    if (const PluginManifest* first = find(manifest.id)) {
      std::error_code error;
      if (std::filesystem::equivalent(first->file, file, error)) return;  // a folder named twice
      warnings_.push_back(
          fmt::format("plugin {} is not used: '{}' is already provided by {}, which comes earlier "
                      "in the search path",
                      file.string(), manifest.id, first->file.string()));
      return;
    }
    plugins_.push_back(std::move(manifest));
  } catch (const config::ConfigError& error) {
    unusable_.push_back({file, fmt::format("its manifest is wrong: {}", error.what())});
  }
}

const PluginManifest* PluginRegistry::find(std::string_view id) const {
  const auto found = std::find_if(plugins_.begin(), plugins_.end(),
                                  [&](const auto& plugin) { return plugin.id == id; });
  return found == plugins_.end() ? nullptr : &*found;
}

const PluginManifest* PluginRegistry::host_of(std::string_view kind) const {
  const auto found = std::find_if(plugins_.begin(), plugins_.end(),
                                  [&](const auto& plugin) { return plugin.hosts == kind; });
  return found == plugins_.end() ? nullptr : &*found;
}

std::string PluginRegistry::unknown_text(std::string_view id) const {
  if (id.empty()) return "a plugin is named by its id, family/name, and not by an empty text";
  std::vector<std::string> folders;
  for (const auto& folder : search_path_) {
    std::error_code none;
    const bool there = std::filesystem::is_directory(folder, none);
    folders.push_back(folder.string() + (there ? "" : " (no such folder)"));
  }
  const auto all = ids_of("", plugins_),
             of_family = ids_of(id.substr(0, id.find('/') + 1), plugins_);
  const std::string near = config::spelling_hint(id, all);
  const std::string meant =
      near.empty() ? config::did_you_mean(id, of_family.empty() ? all : of_family) : near;
  std::string text =
      fmt::format("unknown plugin '{}'{}; searched {}", id, meant, fmt::join(folders, ", "));
  if (search_path_.size() == 1 && near.empty()) {
    text += "; ARMATURE_PLUGIN_PATH adds folders of your own";
  }
  for (const auto& [file, reason] : unusable_) {
    text += fmt::format("; {} cannot be used: {}", file.string(), reason);
  }
  for (const std::string& warning : warnings_) text += "; " + warning;
  return text;
}

std::shared_ptr<PluginLibrary> PluginRegistry::load(const PluginManifest& plugin,
                                                    std::string_view kind) {
  std::weak_ptr<PluginLibrary>& held = loaded_[plugin.id];
  if (auto library = held.lock()) return library;
  const auto own = of_this_program_.find(plugin.id);
  auto library = own == of_this_program_.end() ? PluginLibrary::load(plugin.file, kind)
                                               : PluginLibrary::of_this_program(own->second, kind);
  if (!library) {
    throw PluginError(fmt::format("plugin '{}' cannot be used: {}: {}", plugin.id,
                                  plugin.file.empty() ? "this program" : plugin.file.string(),
                                  library.error().text));
  }
  held = *library;
  return *library;
}

}  // namespace armature
