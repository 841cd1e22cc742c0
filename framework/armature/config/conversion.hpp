// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "armature/config/node.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// Why a node is not what it should be: "must be a number, not 'fast'", and where (an item of a
/// list has its own place).
struct Mismatch {
  Origin origin;
  std::string message;
};

template <class T>
using Converted = tl::expected<T, Mismatch>;

Converted<double> to_number(const Node& node);
Converted<std::int64_t> to_integer(const Node& node);
/// A whole number from 0 to 2^64 - 1.
Converted<std::uint64_t> to_natural(const Node& node);
Converted<bool> to_flag(const Node& node);
Converted<std::string> to_text(const Node& node);
/// A list of `count` numbers; without a count, of any length.
Converted<std::vector<double>> to_numbers(const Node& node, std::optional<std::size_t> count);
/// A list of texts, of any length.
Converted<std::vector<std::string>> to_texts(const Node& node);

}  // namespace config
}  // namespace armature
