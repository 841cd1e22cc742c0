// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "armature/runtime/plugins/abi.hpp"
#include "armature/runtime/plugins/elf_section.hpp"
#include "armature/runtime/plugins/plugin_trial.hpp"
#include "armature/values/header_tags.hpp"

namespace armature {
namespace {

/// The parts of an ABI tag: "ik 1f2e3d4c5b6a" by its words but the last.
std::map<std::string_view, std::string_view> parts_of(std::string_view tag) {
  std::map<std::string_view, std::string_view> parts;
  for (std::size_t begin = 0; begin < tag.size();) {
    const std::size_t end = std::min(tag.find(", ", begin), tag.size());
    const std::string_view part = tag.substr(begin, end - begin);
    parts[part.substr(0, part.rfind(' '))] = part;
    begin = end + 2;
  }
  return parts;
}

/// Why a plugin with this tag must not share objects with us; empty: it may.
std::string difference(std::string_view its_tag) {
  const auto its = parts_of(its_tag);
  const auto ours = parts_of(ARMATURE_ABI_TAG ", " ARMATURE_ALL_HEADERS);
  std::vector<std::string_view> built_for, this_is;
  const auto compare = [&](std::string_view name) {
    const auto a = its.find(name), b = ours.find(name);
    if (a != its.end() && b != ours.end() && a->second == b->second) return;
    if (a != its.end()) built_for.push_back(a->second);
    if (b != ours.end()) this_is.push_back(b->second);
  };
  for (const auto& [name, part] : its) compare(name);
  for (const auto& [name, part] : parts_of(ARMATURE_ABI_TAG)) {
    if (!its.contains(name)) compare(name);
  }
  if (built_for.empty() && this_is.empty()) return {};
  return fmt::format("built for [{}], this is [{}]; rebuild the plugin", fmt::join(built_for, ", "),
                     fmt::join(this_is, ", "));
}

std::optional<std::string> wrong_entry(const PluginEntry& entry, std::string_view kind) {
  if (entry.kind == kind) return std::nullopt;
  return fmt::format("its class is of kind '{}', wanted '{}'", entry.kind, kind);
}

/// A message's symbol names its layout (armature/messages/message_type.hpp).
std::string reason_of_dlopen(std::string reason) {
  if (reason.find("defined_message") != std::string::npos) {
    reason += "; it was built for other members of this message: build it again";
  }
  return reason;
}

}  // namespace

Expected<std::shared_ptr<PluginLibrary>> PluginLibrary::of_this_program(const PluginEntry& entry,
                                                                        std::string_view kind) {
  if (auto wrong = wrong_entry(entry, kind)) return refuse(*wrong);
  return std::shared_ptr<PluginLibrary>(new PluginLibrary({}, nullptr, entry));
}

Expected<std::shared_ptr<PluginLibrary>> PluginLibrary::load(const std::filesystem::path& file,
                                                             std::string_view kind) {
  const auto sections = read_elf_sections(file, {".armature.abi"});
  if (!sections) return tl::unexpected{sections.error()};
  const auto abi = sections->find(".armature.abi");
  if (abi == sections->end())
    return refuse("it carries no ABI tag: not built as an Armature plugin");
  if (const std::string other = difference(abi->second); !other.empty()) return refuse(other);
  if (const auto tried = try_plugin(file); !tried) return tl::unexpected{tried.error()};
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return refuse(reason_of_dlopen(dlerror()));
  const auto* entry = static_cast<const PluginEntry*>(dlsym(handle, "armature_plugin_entry"));
  const auto wrong = entry ? wrong_entry(*entry, kind)
                           : std::optional<std::string>{"it has no ARMATURE_PLUGIN(...) line"};
  if (wrong) {
    dlclose(handle);
    return refuse(*wrong);
  }
  return std::shared_ptr<PluginLibrary>(new PluginLibrary(file, handle, *entry));
}

PluginLibrary::~PluginLibrary() {
  if (handle_) dlclose(handle_);
}

}  // namespace armature
