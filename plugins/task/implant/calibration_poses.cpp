// SPDX-License-Identifier: Apache-2.0
#include "calibration_poses.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace armature::task::implant {
namespace {

/// The digits of `index` in base `prime`, mirrored at the point: from 0 to 1.
double halton(int index, int prime) {
  double value = 0, digit = 1;
  for (; index > 0; index /= prime) value += (digit /= prime) * (index % prime);
  return value;
}

}  // namespace

std::vector<JointVector> calibration_poses(const RobotModel& robot, int count, double spread_rad) {
  constexpr std::array kPrimes{2, 3, 5, 7, 11, 13, 17, 19};
  const JointVector middle = resting_position(robot);
  std::vector<JointVector> poses;
  for (int k = 1; k <= count; ++k) {
    JointVector q = middle;
    for (int i = 0; i < robot.dof(); ++i) {
      if (!robot.is_revolute(i)) continue;
      const int prime = kPrimes[static_cast<std::size_t>(i) % kPrimes.size()];
      q[i] = std::clamp(q[i] + spread_rad * (2 * halton(k, prime) - 1), robot.lower()[i],
                        robot.upper()[i]);
    }
    poses.push_back(q);
  }
  return poses;
}

}  // namespace armature::task::implant
