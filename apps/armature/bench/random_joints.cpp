// SPDX-License-Identifier: Apache-2.0
#include "bench/random_joints.hpp"

#include <cmath>
#include <numbers>

namespace armature::bench {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::pair<double, double> range(const RobotModel& model, int i) {
  const double lower = model.lower()[i], upper = model.upper()[i];
  const bool finite = std::isfinite(lower) && std::isfinite(upper);
  return finite ? std::pair{lower, upper} : std::pair{-std::numbers::pi, std::numbers::pi};
}

JointVector anywhere(const RobotModel& model, std::mt19937_64& random) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    const auto [lower, upper] = range(model, i);
    q[i] = lower + unit(random) * (upper - lower);
  }
  return q;
}

}  // namespace armature::bench
