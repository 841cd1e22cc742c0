// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {
namespace config ARMATURE_EXPORT {

/// A value's conversion, or a problem already noted. Numbers: decimal integers and floats that a
/// double can hold; `.inf`, `.nan`, `1_000`, `0x10` and quoted numbers are refused, `010` as
/// ambiguous. Flags: only `true` and `false`. A text may be any scalar.
std::optional<double> as_number(const Node& node, Problems& problems);
std::optional<std::int64_t> as_integer(const Node& node, Problems& problems);
std::optional<bool> as_flag(const Node& node, Problems& problems);
std::optional<std::string> as_text(const Node& node, Problems& problems);
std::optional<std::vector<double>> as_numbers(const Node& node, Problems& problems);

/// Reads one map strictly: what is asked for is known, everything else is an unknown key. Every
/// problem goes to `problems`; a missing or wrong value reads as the fallback so that reading can
/// go on and find the next problem.
///
///     MapReader map{node, "joint", problems};
///     joint.name = map.text("name");
///     joint.d_m = map.number("d_m", 0.0);
///     map.finish();
class MapReader {
 public:
  /// `what` names the map in messages: "joint", "component 'arm'".
  MapReader(const Node& node, std::string what, Problems& problems);

  /// Required values: a missing one is a problem, and reads as 0, "", `count` zeros, nullptr.
  double number(std::string_view key);
  std::string text(std::string_view key);
  std::vector<double> numbers(std::string_view key, std::size_t count);
  const Node* node(std::string_view key);

  /// Optional values.
  double number(std::string_view key, double fallback);
  std::int64_t integer(std::string_view key, std::int64_t fallback);
  /// From 0 to 2^64 - 1.
  std::uint64_t natural(std::string_view key, std::uint64_t fallback);
  bool flag(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback);
  /// One of `allowed`, or a problem with the nearest of them.
  std::string choice(std::string_view key, const std::vector<std::string>& allowed,
                     std::string fallback);
  std::optional<std::vector<double>> optional_numbers(std::string_view key, std::size_t count);
  const Node* optional_node(std::string_view key);

  /// Notes a problem at the value of `key` (or at the map when the key is missing).
  void problem(std::string_view key, std::string message);
  /// Every key that was never asked for is an unknown key, with did-you-mean.
  void finish();

 private:
  const Node* look(std::string_view key);

  const Node& node_;
  std::string what_;
  Problems& problems_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace config
}  // namespace armature
