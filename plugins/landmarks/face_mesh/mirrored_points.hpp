// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace armature::landmarks::face_mesh {

inline constexpr std::size_t kPoints = 468;

/// The point of the other half of the face that a mirrored picture shows where each point is. The
/// mesh numbers one half with the middle line, then the other half in the same order.
inline constexpr std::array<std::size_t, kPoints> kMirroredPoints = [] {
  constexpr std::array<std::size_t, 28> kMiddle{0,   1,   2,   4,   5,   6,   8,   9,  10, 11,
                                                12,  13,  14,  15,  16,  17,  18,  19, 94, 151,
                                                152, 164, 168, 175, 195, 197, 199, 200};
  constexpr std::size_t kFirstHalf = (kPoints + kMiddle.size()) / 2;
  std::array<std::size_t, kPoints> mirrored{};
  std::size_t other = kFirstHalf;
  for (std::size_t i = 0; i < kFirstHalf; ++i) {
    mirrored[i] = std::ranges::binary_search(kMiddle, i) ? i : other++;
    mirrored[mirrored[i]] = i;
  }
  return mirrored;
}();

}  // namespace armature::landmarks::face_mesh
