// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <optional>
#include <string>

#include "armature/runtime/plugins/abi.hpp"
#include "armature/runtime/plugins/elf_section.hpp"
#include "armature/runtime/plugins/plugin_trial.hpp"

namespace armature {
namespace {

std::optional<std::string> wrong_entry(const PluginEntry& entry, std::string_view kind,
                                       int kind_version) {
  if (entry.kind != kind) {
    return fmt::format("its class is of kind '{}', wanted '{}'", entry.kind, kind);
  }
  if (entry.kind_version != kind_version) {
    return fmt::format("it implements version {} of kind '{}', this is version {}",
                       entry.kind_version, kind, kind_version);
  }
  return std::nullopt;
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
                                                                        std::string_view kind,
                                                                        int kind_version) {
  if (auto wrong = wrong_entry(entry, kind, kind_version)) return refuse(*wrong);
  return std::shared_ptr<PluginLibrary>(new PluginLibrary({}, nullptr, entry));
}

Expected<std::shared_ptr<PluginLibrary>> PluginLibrary::load(const std::filesystem::path& file,
                                                             std::string_view kind,
                                                             int kind_version) {
  const auto sections = read_elf_sections(file, {".armature.abi"});
  if (!sections) return tl::unexpected{sections.error()};
  const auto abi = sections->find(".armature.abi");
  if (abi == sections->end())
    return refuse("it carries no ABI tag: not built as an Armature plugin");
  if (abi->second != ARMATURE_ABI_TAG) {
    return refuse(fmt::format("built for [{}], this is [{}]; rebuild the plugin", abi->second,
                              ARMATURE_ABI_TAG));
  }
  if (const auto tried = try_plugin(file); !tried) return tl::unexpected{tried.error()};
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return refuse(reason_of_dlopen(dlerror()));
  const auto* entry = static_cast<const PluginEntry*>(dlsym(handle, "armature_plugin_entry"));
  const auto wrong = entry ? wrong_entry(*entry, kind, kind_version)
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
