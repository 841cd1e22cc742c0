// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "armature/config/document.hpp"
#include "armature/config/source_text.hpp"
#include "armature/runtime/deployment_file/sha256.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using config::Node;

/// Its length goes first, so that no two sets of parts make the same text.
void append(std::string& text, std::string_view part) {
  text += fmt::format("{}:{}", part.size(), part);
}

/// The contents of the YAML and URDF files that the texts in `node` name.
void append_named_files(std::string& text, const Node& node) {
  for (const Node& item : node.items()) append_named_files(text, item);
  for (const auto& [key, origin, value] : node.entries()) append_named_files(text, value);
  if (node.kind() != Node::Kind::scalar) return;
  const fs::path file = config::folder_of(node.origin()) / node.text();
  constexpr std::array kRead{".yaml", ".yml", ".urdf"};
  if (std::ranges::find(kRead, file.extension()) == kRead.end()) return;
  try {
    append(text, config::read_source(file, node.origin()));
  } catch (const config::ConfigError&) {
    append(text, "");  // whoever needs the file says what is wrong with it
  }
}

}  // namespace

std::string fingerprint_of(const Node& root, const DeploymentConfig& deployment) {
  std::string text;
  for (const auto& [key, origin, value] : root.entries()) {
    // Of a machine and of who watches, not of what runs.
    if (key == "dds" || key == "domain" || key == "record") continue;
    append(text, key);
    append(text, config::to_yaml(value, false));
  }
  for (const auto& [section, documents] : deployment.documents) {
    for (const auto& [name, document] : documents) {
      append(text, section + "." + name);
      append(text, config::to_yaml(document, false));
      append_named_files(text, document);
    }
  }
  return sha256(text);
}

}  // namespace armature
