// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/key.hpp"
#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// The text of a scalar, or nothing and a problem that is noted.
std::optional<std::string> as_text(const Node& node, Problems& problems);

/// Reads one map strictly, by the table of the keys that it may have. Every problem goes to
/// `problems`; a missing or wrong value reads as its default, 0 or "", so that reading can go on
/// and find the next problem.
///
///     const std::vector<KeySpec> kKeys{text("name", "Of the joint."),  // key_rows.hpp
///                                      number("d_m", "Offset.").fallback("0").also("d_mm")};
///     MapReader map{node, "joint", kKeys, problems};
///     joint.name = map.text("name");
///     joint.d = map.number("d_m");  // in metres, also when the file says d_mm
///     map.finish();
///
/// Asking for a key that is not in the table, or as another type, and a key of the table that was
/// never asked for when all is read, are defects of the code and throw std::logic_error.
class MapReader {
 public:
  /// `what` names the map in messages: "joint", "component 'arm'". `table` must live as long.
  MapReader(const Node& node, std::string what, std::span<const KeySpec> table, Problems& problems);
  /// Of a map without a table: each key is described where it is asked for.
  MapReader(const Node& node, std::string what, Problems& problems);

  /// Values in SI units. Without a table the key is required.
  double number(std::string_view key);
  std::int64_t integer(std::string_view key);
  /// An integer from 0 to 2^64 - 1.
  std::uint64_t natural(std::string_view key);
  bool flag(std::string_view key);
  /// A text or a choice.
  std::string text(std::string_view key);
  /// What stands under the key as it was written, or nullptr.
  const Node* node(std::string_view key);

  /// Nothing when it is missing, and no default stands for it, or wrong.
  std::optional<double> optional_number(std::string_view key);
  std::optional<std::int64_t> optional_integer(std::string_view key);
  std::optional<std::vector<double>> optional_numbers(std::string_view key);
  std::optional<std::vector<std::string>> optional_texts(std::string_view key);

  /// Without a table: values with their defaults, and keys that may be missing.
  double number(std::string_view key, double fallback);
  std::int64_t integer(std::string_view key, std::int64_t fallback);
  bool flag(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback);
  std::string choice(std::string_view key, const std::vector<std::string>& allowed,
                     std::string fallback);
  const Node* optional_node(std::string_view key);

  /// The key's name, or the `also` of it under which a value is written.
  std::string written(std::string_view key);
  /// Notes a problem at the value of `key` (or at the map when the key is missing).
  void problem(std::string_view key, std::string message);
  /// Every key that is not in the table, or without a table was never asked for, is an unknown key.
  void finish();

  /// One key, whatever the table says.
  struct Reading {
    const Node* node = nullptr;  // as written, or the default; null: neither
    bool is_written = false;
    std::optional<Value> value;  // none: missing or wrong
  };
  Reading read(const KeySpec& key);

 private:
  KeySpec spec_of(std::string_view key, std::initializer_list<KeySpec::Type> types);
  KeySpec untabled(std::string_view key, KeySpec::Type type) const;
  const Node* find(const KeySpec& key, std::string_view* written = nullptr);
  template <class T>
  std::optional<T> get(const KeySpec& key);

  const Node& node_;
  std::string what_;
  std::optional<std::span<const KeySpec>> table_;
  Problems& problems_;
  std::set<std::string, std::less<>> keys_read_;
};

}  // namespace config
}  // namespace armature
