// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "armature/config/key.hpp"

namespace armature {

// JSON Schemas of single values. Each takes what reading takes: a `${NAME}` where a number, a flag
// or a choice stands, any scalar as a text, and the null by which an overlay removes a key.

/// Of a parameter, with its doc and its default.
nlohmann::ordered_json schema_of(const ParamSpec& spec);
/// Of a key that has a type.
nlohmann::ordered_json schema_of(const config::Key& key);
/// Of a text.
nlohmann::ordered_json text_schema(std::string_view doc);
/// Of one of `words`.
nlohmann::ordered_json word_schema(const std::vector<std::string>& words, std::string_view doc);
/// Of a path or a list of paths.
nlohmann::ordered_json paths_schema(std::string_view doc);

/// Of a map that has these keys and no other.
nlohmann::ordered_json map_schema(std::string_view doc, nlohmann::ordered_json properties);
/// Of a map whose keys are free.
nlohmann::ordered_json names_schema(std::string_view doc, nlohmann::ordered_json of_each);
/// The properties of a map of keys that all have a type.
nlohmann::ordered_json properties_of(std::span<const config::Key> keys);
/// The `params:` of these.
nlohmann::ordered_json params_schema(const std::vector<ParamSpec>& specs);

}  // namespace armature
