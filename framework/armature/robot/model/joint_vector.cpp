// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/joint_vector.hpp"

#include <cmath>
#include <numbers>

namespace armature {

bool at_rest(const JointState& state) {
  return state.v.cwiseAbs().maxCoeff() < 1e-9 && state.a.cwiseAbs().maxCoeff() < 1e-9;
}

double wrap_angle(double angle) {
  constexpr double kPi = std::numbers::pi;
  if (angle >= -kPi && angle < kPi) return angle;  // already there: not a bit is changed
  // A turn less or more is exact there.
  const bool near = std::abs(angle) < 3 * kPi;
  const double wrapped =
      near ? angle - std::copysign(2 * kPi, angle) : std::remainder(angle, 2 * kPi);
  return wrapped >= kPi ? -kPi : wrapped;
}

}  // namespace armature
