// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {
namespace ik_contract ARMATURE_EXPORT {

/// Where a joint is looked for.
struct Range {
  double lower = 0, upper = 0;
};
/// After how many turns of independent joint `i` the arm is as before: two, when half of what it
/// does is coupled to it. 0: it slides or moves what slides, or a dozen turns are not enough.
int turns_until_same(const RobotModel& model, int i);

/// The limits of independent joint `i`, at most one turn of them; when `free`, all the turns after
/// which the arm is as before, of a joint that has such.
Range range_of(const RobotModel& model, int i, bool free = false);

/// Uniform within `range_of` every joint.
JointVector random_posture(const RobotModel& model, std::mt19937_64& random, bool free = false);

/// The least value of `f` between `lower` and `upper`, by golden section: exact for a minimum with
/// a corner, to the root of the rounding for a smooth one.
template <class Function>
double golden_section(double lower, double upper, Function f) {
  constexpr double kGolden = 0.6180339887498949;
  double a = upper - kGolden * (upper - lower), b = lower + kGolden * (upper - lower);
  double at_a = f(a), at_b = f(b);
  for (int i = 0; i < 90 && a < b; ++i) {
    if (at_a <= at_b) {
      upper = b, b = a, at_b = at_a;
      a = upper - kGolden * (upper - lower), at_a = f(a);
    } else {
      lower = a, a = b, at_a = at_b;
      b = lower + kGolden * (upper - lower), at_b = f(b);
    }
  }
  return at_a <= at_b ? a : b;
}

}  // namespace ik_contract
}  // namespace armature
