// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace armature {

/// What the fit of all poses says of one of them.
struct Deletion {
  double remaining = 1;  // of the sum of squares, when it is left out
  double moved = 0;      // by which the rest then misses it, in the unit of `least`
};

/// The index of a pose that does not fit the others, or nullopt. Left out, it would take more from
/// the sum of squares than chance takes once in a million calibrations (an F test, of equations of
/// normal errors: `freedom` of them are left over without the pose, which has 2 `half` or one
/// less). Nothing is said of misfits below `least`, where rounding is not normal.
std::optional<std::size_t> outlying_pose(std::span<const Deletion> deletions, double freedom,
                                         int half, double least);

}  // namespace armature
