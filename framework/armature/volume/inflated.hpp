// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// What zlib takes and gives in one call at most: its counters have 32 bits.
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 30;

/// What gzip compressed, at most `max_bytes` of it: a small file can claim to be a huge one. Comes
/// in pieces of `piece_bytes` (1 to 2^32 - 1), so that neither may be larger than memory alone.
/// Refuses what is not gzip or damaged, and what ends before both its own end and `max_bytes`.
Expected<std::string> inflated(std::string_view gzip, std::size_t max_bytes,
                               std::size_t piece_bytes = kPieceBytes);

}  // namespace armature
