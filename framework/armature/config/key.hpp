// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/config/conversion.hpp"
#include "armature/config/node.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// One key that a map in a file may have. Reading, checking, defaults and the JSON Schema all come
/// from it: a file format is tables of these.
struct KeySpec {
  enum class Type { number, integer, flag, text, choice, numbers, texts, file, section };
  std::string name;          // its end says the unit that the user writes (unit_suffix.hpp)
  Type type = Type::number;  // section: a map or a list that has rules of its own
  std::string doc{};
  std::optional<Node> fallback{};      // stands for a key that is missing
  std::optional<double> min{}, max{};  // of every number, in the user's unit, inclusive
  std::vector<std::string> choices{};
  std::optional<std::size_t> count{};  // of numbers; none: any
  std::string because{};               // ends the message of a number out of its range

  bool optional = false;          // the key may be missing although nothing stands for it
  std::optional<double> above{};  // as `min`, exclusive
  std::string also{};             // the key that says the same in another unit: "d_mm" of "d_m"
};

/// What a table states as fallback: the text that a user would write.
Node default_value(std::string text);

/// The first key of a file, `armature_robot: 1`.
KeySpec format_key(std::string name);

/// A value in SI units, by type: number; integer; flag; text, choice and file; numbers; texts.
using Value = std::variant<double, std::int64_t, bool, std::string, std::vector<double>,
                           std::vector<std::string>>;

/// What `node` says under `written`, which is the key's name or `also`: `_deg` arrives in radians,
/// `_mm` in metres. A relative path of type file starts at `folder`.
Converted<Value> to_value(const KeySpec& key, std::string_view written, const Node& node,
                          const std::string& folder);

/// What stands for a value that could not be read, so that asking for it has an answer.
Value zero_of(KeySpec::Type type);

}  // namespace config
}  // namespace armature
