// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/described_messages.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstddef>

#include "armature/messages/known_types.hpp"
#include "armature/runtime/plugins/plugin_trial.hpp"

namespace armature {

std::vector<std::string> describe_messages(const PluginRegistry& plugins) {
  std::vector<PluginRegistry::Messages> left = plugins.messages();
  for (std::size_t before = left.size() + 1; left.size() < before;) {  // one may nest another's
    before = left.size();
    std::erase_if(left, [](const auto& library) {
      return add_descriptions(library.idl, library.file.string()).has_value();
    });
  }
  std::vector<std::string> problems;
  for (const auto& [file, idl] : left) {
    problems.push_back("its messages cannot be shown: " +
                       add_descriptions(idl, file.string()).error().text);
  }
  return problems;
}

std::vector<std::string> load_messages(const PluginRegistry& plugins, std::string_view name) {
  std::vector<std::string> problems;
  for (const auto& [file, idl] : plugins.messages()) {
    if (idl.find(fmt::format("struct {}", name)) == std::string::npos) continue;
    const auto tried = try_plugin(file);
    // For as long as the process lives: its types stay known.
    if (tried && dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL)) continue;
    problems.push_back(fmt::format("the messages of '{}' cannot be made: {}", file.string(),
                                   tried ? dlerror() : tried.error().text));
  }
  return problems;
}

}  // namespace armature
