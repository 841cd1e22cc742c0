// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>

namespace armature {

/// Which shoulder and which wrist: as found (0) or flipped (1).
struct Flips {
  std::size_t shoulder = 0, wrist = 0;
};

/// One of the eight, in the order in which they are answered. Shoulder 0: sin t2 >= 0; elbow 0:
/// t4 >= 0; wrist 0: sin t6 >= 0, of SrsArm's angles.
struct Branch {
  std::string_view label;
  std::size_t elbow;
  Flips flips;
};

inline constexpr std::array<Branch, 8> kBranches{{{"shoulder0/elbow0/wrist0", 0, {0, 0}},
                                                  {"shoulder0/elbow0/wrist1", 0, {0, 1}},
                                                  {"shoulder0/elbow1/wrist0", 1, {0, 0}},
                                                  {"shoulder0/elbow1/wrist1", 1, {0, 1}},
                                                  {"shoulder1/elbow0/wrist0", 0, {1, 0}},
                                                  {"shoulder1/elbow0/wrist1", 0, {1, 1}},
                                                  {"shoulder1/elbow1/wrist0", 1, {1, 0}},
                                                  {"shoulder1/elbow1/wrist1", 1, {1, 1}}}};

/// An arm of elbow 1 at an arm angle stands where that of elbow 0 does, less this [rad].
inline double half_turns(std::size_t elbow) { return elbow == 0 ? 0 : std::numbers::pi; }

}  // namespace armature
