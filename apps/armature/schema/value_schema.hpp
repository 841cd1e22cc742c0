// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "armature/config/key.hpp"
#include "armature/config/params.hpp"

namespace armature {

// JSON Schemas of single values. Each takes what reading takes: a `${NAME}` where a number, a flag
// or a choice stands, any scalar as a text, and the null by which an overlay removes a key.

/// Of a key or a parameter, with its doc and its default; a section may be anything.
nlohmann::ordered_json schema_of(const config::KeySpec& key);
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
/// The properties of a map of these keys, each under all the names that it may be written by.
nlohmann::ordered_json properties_of(std::span<const config::KeySpec> keys);
/// The `params:` of these.
nlohmann::ordered_json params_schema(const std::vector<ParamSpec>& specs);

}  // namespace armature
