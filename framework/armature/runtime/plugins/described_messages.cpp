// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/described_messages.hpp"

#include <cstddef>

#include "armature/messages/known_types.hpp"

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

}  // namespace armature
