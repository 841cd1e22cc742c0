// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/plan.hpp"

#include <cstddef>

namespace armature {

Trajectory joined(const Trajectory& first, const Trajectory& second) {
  Trajectory both = first;
  both.goal_id = second.goal_id;
  const double offset = to_seconds(second.start - first.start);
  both.knots.back() = offset;
  for (std::size_t k = 1; k < second.knots.size(); ++k) {
    both.knots.push_back(offset + second.knots[k]);
  }
  both.pieces.insert(both.pieces.end(), second.pieces.begin(), second.pieces.end());
  return both;
}

}  // namespace armature
