// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "armature/messages/type_description.hpp"

namespace armature {

/// Where two messages of one type differ first, in the order of the IDL.
struct MessageDifference {
  std::string field;  // "position[2]"
  std::string recorded, replayed;
  std::optional<std::uint64_t> ulps;  // of numbers: how many floating-point numbers lie between
};

/// Nothing: they are the same. Numbers are compared by their bits, so that NaN equals NaN.
std::optional<MessageDifference> first_difference(const TypeDescription& type,
                                                  std::span<const std::byte> recorded,
                                                  std::span<const std::byte> replayed);

}  // namespace armature
