// SPDX-License-Identifier: Apache-2.0
#include "inspect/origin_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "armature/config/conversion.hpp"

namespace armature {
namespace {

/// What every reader of YAML takes it for; a text that looks like a number is one in quotes.
nlohmann::ordered_json scalar_json(const config::Node& node) {
  if (node.kind() == config::Node::Kind::null) return nullptr;
  if (const auto flag = config::to_flag(node)) return *flag;
  if (const auto whole = config::to_integer(node)) return *whole;
  if (const auto number = config::to_number(node); number && std::isfinite(*number)) {
    return *number;
  }
  return node.text();
}

}  // namespace

nlohmann::ordered_json origin_json(const config::Origin& origin) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (!origin.file.empty()) json["file"] = origin.file;
  if (origin.line > 0) {
    json["line"] = origin.line;
    json["column"] = origin.column;
  }
  return json;
}

nlohmann::ordered_json with_origins(const config::Node& node) {
  using Kind = config::Node::Kind;
  if (node.kind() == Kind::map) {
    nlohmann::ordered_json map = nlohmann::ordered_json::object();
    for (const auto& entry : node.entries()) map[entry.key] = with_origins(entry.value);
    return map;
  }
  if (node.kind() == Kind::sequence) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const config::Node& item : node.items()) list.push_back(with_origins(item));
    return list;
  }
  return {{"value", scalar_json(node)}, {"origin", origin_json(node.origin())}};
}

}  // namespace armature
