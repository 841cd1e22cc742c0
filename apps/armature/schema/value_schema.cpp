// SPDX-License-Identifier: Apache-2.0
#include "schema/value_schema.hpp"

#include <nlohmann/json.hpp>

#include "armature/config/conversion.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;
using Type = config::KeySpec::Type;

/// What a number or a flag may be instead, which is known only where it is read.
constexpr const char* kVariable = "\\$\\{";

void add_limits(Json& schema, const config::KeySpec& key, double scale) {
  if (key.min) schema["minimum"] = *key.min * scale;
  if (key.max) schema["maximum"] = *key.max * scale;
  if (key.above) schema["exclusiveMinimum"] = *key.above * scale;
}

Json scalar_schema(const char* type) {
  return {{"type", {type, "string", "null"}}, {"pattern", kVariable}};
}

/// The items of a list have no null: an overlay replaces the whole list.
Json list_schema(Json item, const std::optional<std::size_t>& count) {
  item["type"].erase(item["type"].size() - 1);
  Json schema{{"type", {"array", "null"}}, {"items", std::move(item)}};
  if (count) schema["minItems"] = schema["maxItems"] = *count;
  return schema;
}

/// Without doc and default; `scale`: what limits are multiplied by.
Json type_schema(const config::KeySpec& key, double scale) {
  Json schema = Json::object();
  switch (key.type) {
    case Type::number:
    case Type::integer:
      schema = scalar_schema(key.type == Type::number ? "number" : "integer");
      add_limits(schema, key, scale);
      return schema;
    case Type::flag: return scalar_schema("boolean");
    case Type::text:
    case Type::file: return text_schema("");
    case Type::choice: return word_schema(key.choices, "");
    case Type::numbers:
      schema = scalar_schema("number");
      add_limits(schema, key, scale);
      return list_schema(std::move(schema), key.count);
    case Type::texts: return list_schema(text_schema(""), key.count);
    case Type::section: break;
  }
  return schema;
}

Json value_of(const config::KeySpec& key, const config::Node& node) {
  const auto as_json = [](auto value) { return value ? Json(*value) : Json(); };
  switch (key.type) {
    case Type::number: return as_json(config::to_number(node));
    case Type::integer: return as_json(config::to_integer(node));
    case Type::flag: return as_json(config::to_flag(node));
    case Type::numbers: return as_json(config::to_numbers(node, key.count));
    case Type::texts: return as_json(config::to_texts(node));
    case Type::text:
    case Type::file:
    case Type::choice: return as_json(config::to_text(node));
    case Type::section: break;
  }
  return {};
}

Json with_doc(std::string_view doc, Json schema) {
  if (!doc.empty()) schema["description"] = doc;
  return schema;
}

}  // namespace

Json schema_of(const config::KeySpec& key) {
  Json schema = with_doc(key.doc, type_schema(key, 1));
  if (key.fallback) schema["default"] = value_of(key, *key.fallback);
  return schema;
}

Json text_schema(std::string_view doc) {
  return with_doc(doc, {{"type", {"string", "number", "boolean", "null"}}});
}

Json word_schema(const std::vector<std::string>& words, std::string_view doc) {
  Json all = words;
  for (const std::string& word : words) {
    // What YAML takes for a number or a flag is a text all the same.
    const Json read = Json::parse(word, nullptr, false);
    if (read.is_number() || read.is_boolean()) all.push_back(read);
  }
  all.push_back(nullptr);
  const Json variable{{"type", "string"}, {"pattern", kVariable}};
  return with_doc(doc, {{"anyOf", Json::array({Json{{"enum", std::move(all)}}, variable})}});
}

Json paths_schema(std::string_view doc) {
  const Json path{{"type", {"string", "number", "boolean"}}};
  return with_doc(doc, {{"anyOf", Json::array({path, Json{{"type", "array"}, {"items", path}}})}});
}

Json map_schema(std::string_view doc, Json properties) {
  return with_doc(doc, {{"type", {"object", "null"}},
                        {"properties", std::move(properties)},
                        {"additionalProperties", false}});
}

Json names_schema(std::string_view doc, Json of_each) {
  return with_doc(doc,
                  {{"type", {"object", "null"}}, {"additionalProperties", std::move(of_each)}});
}

Json properties_of(std::span<const config::KeySpec> keys) {
  Json properties = Json::object();
  for (const config::KeySpec& key : keys) {
    properties[key.name] = schema_of(key);
    if (key.also.empty()) continue;
    const double scale = config::si_factor(key.name) / config::si_factor(key.also);
    properties[key.also] = with_doc(key.doc, type_schema(key, scale));
  }
  return properties;
}

Json params_schema(const std::vector<ParamSpec>& specs) {
  Json properties = Json::object();
  for (const ParamSpec& spec : specs) properties[spec.name] = schema_of(spec);
  return map_schema("The plugin's parameters.", std::move(properties));
}

}  // namespace armature
