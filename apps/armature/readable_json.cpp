// SPDX-License-Identifier: Apache-2.0
#include "readable_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 100;

/// `"key": ` of an object's member, nothing of a list's.
std::string label(const Json& container, const Json::const_iterator& item) {
  return container.is_object() ? json_text(Json(item.key())) + ": " : "";
}

std::string one_line(const Json& json) {
  if (!json.is_structured()) return json_text(json);
  std::string text;
  for (auto item = json.begin(); item != json.end(); ++item) {
    text += (text.empty() ? "" : ", ") + label(json, item) + one_line(*item);
  }
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

bool is_plain_list(const Json& json) {
  return json.is_array() && std::none_of(json.begin(), json.end(),
                                         [](const Json& item) { return item.is_structured(); });
}

std::string indented(const Json& json, std::size_t depth) {
  std::string line = one_line(json);
  if (!json.is_structured() || is_plain_list(json) || depth + line.size() <= kColumns) return line;
  std::string text;
  for (auto item = json.begin(); item != json.end(); ++item) {
    text += (text.empty() ? "\n" : ",\n") + std::string(depth + 1, ' ') + label(json, item) +
            indented(*item, depth + 1);
  }
  text += "\n" + std::string(depth, ' ');
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace

std::string readable(const Json& json) { return indented(json, 0); }

}  // namespace armature
