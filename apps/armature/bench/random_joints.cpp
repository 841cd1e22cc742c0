// SPDX-License-Identifier: Apache-2.0
#include "bench/random_joints.hpp"

#include <cmath>
#include <numbers>

#include "armature/values/chance.hpp"

namespace armature::bench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

double unit(std::mt19937_64& random) { return share_of(random()); }

Eigen::Quaterniond any_rotation(std::mt19937_64& random) {
  const double u = unit(random), a = kTurn * unit(random), b = kTurn * unit(random);
  const double low = std::sqrt(1 - u), high = std::sqrt(u);
  return {high * std::cos(b), low * std::sin(a), low * std::cos(a), high * std::sin(b)};
}

std::pair<double, double> range(const RobotModel& model, int i) {
  const double lower = model.lower()[i], upper = model.upper()[i];
  if (std::isfinite(lower) && std::isfinite(upper)) return {lower, upper};
  if (std::isfinite(lower)) return {lower, lower + kTurn};
  if (std::isfinite(upper)) return {upper - kTurn, upper};
  return {-kTurn / 2, kTurn / 2};
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
