// SPDX-License-Identifier: Apache-2.0
// Which entry of `robots:` and `rigs:` a component is for.
#include <fmt/format.h>

#include <algorithm>

#include "armature/runtime/deployment_file/component_config.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;

// `rig: none`: this component uses no rig although there is one.
constexpr std::string_view kNoDocument = "none";

}  // namespace

/// `robot: left` binds an entry of `robots:`; with a single entry nothing needs to be said.
void ComponentReader::bind_documents(MapReader& map, ComponentConfig& component) const {
  const auto lists = [](const std::vector<std::string>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const auto& [section, word] : kDocumentSections) {
    const bool needed = lists(component.manifest->uses, word);
    const Node* named = map.node(word);
    if (named && named->kind() != Node::Kind::scalar) {
      problems_.add(named->origin(), fmt::format("'{}' must name an entry of '{}', not {}", word,
                                                 section, named->describe()));
      continue;
    }
    if (needed || lists(component.manifest->may_use, word)) {
      bind_document({section, word, needed}, named, component);
    } else if (named) {
      problems_.add(named->origin(),
                    fmt::format("component '{}' uses no {}", component.name, word));
    }
  }
}

void ComponentReader::bind_document(const DocumentUse& use, const Node* named,
                                    ComponentConfig& component) const {
  const std::string section{use.section};
  std::vector<std::string> names;
  for (const auto& [name, document] : deployment_.documents.at(section)) names.push_back(name);
  const bool named_none = !use.needed && named && named->text() == kNoDocument;
  if (named_none || (!named && !use.needed && names.empty())) return;
  if (named) {
    if (std::find(names.begin(), names.end(), named->text()) != names.end()) {
      component.documents[section] = named->text();
    } else {
      problems_.add(named->origin(), fmt::format("unknown {} '{}'{}", use.word, named->text(),
                                                 config::did_you_mean(named->text(), names)));
    }
  } else if (names.size() == 1) {
    component.documents[section] = names.front();
  } else if (names.empty()) {
    problems_.add(component.origin, fmt::format("component '{}' needs a {}: add '{}: {{name: "
                                                "file.yaml}}'",
                                                component.name, use.word, use.section));
  } else {
    problems_.add(
        component.origin,
        fmt::format("component '{}' must say which {}: '{}: ...'{}", component.name, use.word,
                    use.word, use.needed ? "" : fmt::format(", or '{}: none'", use.word)));
  }
}

}  // namespace armature
