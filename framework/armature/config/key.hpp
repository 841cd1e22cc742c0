// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/params.hpp"

namespace armature ARMATURE_EXPORT {
namespace config ARMATURE_EXPORT {

/// One key that a file may have and that is no plugin's parameter. Reading asks for it, and the
/// JSON Schema is made from it.
struct Key {
  std::string_view name;                // its end says the unit
  std::optional<ParamSpec::Type> type;  // none: a map or a list that has its own rules
  std::string_view doc;
  std::optional<double> min{}, max{};         // inclusive
  std::array<std::string_view, 2> choices{};  // of a choice
};

constexpr bool is_within(const Key& key, double value) {
  return !(key.min && value < *key.min) && !(key.max && value > *key.max);
}

inline std::vector<std::string> choices_of(const Key& key) {
  return {key.choices.begin(), key.choices.end()};
}

}  // namespace config
}  // namespace armature
