// SPDX-License-Identifier: Apache-2.0
#include "descent.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "armature/robot/model/axis_steps.hpp"

namespace armature::ik::numeric::descent {
namespace {

Lanes lanes(const Eigen::Vector3d& v) { return Lanes{v.x(), v.y(), v.z(), 0}; }

/// The longest step of an independent joint in one iteration: 1 rad or 1 m, of a long slide a
/// quarter of its range, or it would take hundreds of them.
double longest_step(const RobotModel& model, int joint) {
  const double range = model.upper()[joint] - model.lower()[joint];
  const bool is_long = !model.is_revolute(joint) && std::isfinite(range);
  return is_long ? std::max(1.0, 0.25 * range) : 1.0;
}

}  // namespace

Chain chain_of(const RobotModel& model) {
  const NamedFrame& tool = model.frame(model.tool());
  const auto steps = axis_steps(model, model.tool());
  Chain chain;
  chain.joints = tool.parent_joint + 1;
  chain.dof = model.dof();
  std::copy(model.lower().begin(), model.lower().end(), chain.lower.begin());
  std::copy(model.upper().begin(), model.upper().end(), chain.upper.begin());
  for (int j = 0; j < chain.dof; ++j) {
    chain.per_longest_step[static_cast<std::size_t>(j)] = 1 / longest_step(model, j);
  }
  for (int i = 0; i < chain.joints; ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    const Eigen::Isometry3d& step = steps[static_cast<std::size_t>(i)];
    chain.step[static_cast<std::size_t>(i)] = {.x = lanes(step.linear().col(0)),
                                               .y = lanes(step.linear().col(1)),
                                               .z = lanes(step.linear().col(2)),
                                               .origin = lanes(step.translation()),
                                               .prismatic = link.prismatic,
                                               .independent = link.independent,
                                               .ratio = link.ratio,
                                               .offset = link.offset};
  }
  const Eigen::Isometry3d& last = steps.back();
  chain.tool_x = lanes(last.linear().col(0));
  chain.tool_y = lanes(last.linear().col(1));
  chain.tool_z = lanes(last.linear().col(2));
  chain.tool_origin = lanes(last.translation());
  chain.pointing_axis = lanes(model.pointing_axis().value_or(Eigen::Vector3d::UnitX()));
  return chain;
}

Goal goal_of(const IkGoal& goal) {
  Goal result{.position = lanes(goal.pose.position),
              .x = {},
              .y = {},
              .z = {},
              .pointing = std::holds_alternative<Direction>(goal.pose.orientation),
              .position_m = goal.tolerance.position_m,
              .chord = 2 * std::sin(0.5 * std::min(goal.tolerance.angle_rad, std::numbers::pi))};
  if (result.pointing) {
    result.x = lanes(std::get<Direction>(goal.pose.orientation).unit.normalized());
  } else {
    const Eigen::Matrix3d R =
        std::get<Eigen::Quaterniond>(goal.pose.orientation).normalized().toRotationMatrix();
    result.x = lanes(R.col(0));
    result.y = lanes(R.col(1));
    result.z = lanes(R.col(2));
  }
  return result;
}

const Kernel& kernel() {
#if defined(__x86_64__)
  static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2) return avx2_kernel();
#endif
  return portable_kernel();
}

}  // namespace armature::ik::numeric::descent
