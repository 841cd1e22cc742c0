// SPDX-License-Identifier: Apache-2.0
#include "descent.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace armature::descent {
namespace {

Lanes lanes(const Eigen::Vector3d& v) { return Lanes{v.x(), v.y(), v.z(), 0}; }

/// Rz(theta) Tz(d), and Tx(a) Rx(alpha); the two of a row commute.
Eigen::Isometry3d screw_along_z(const ChainLink& link) {
  return Eigen::Translation3d{0, 0, link.d} *
         Eigen::AngleAxisd{link.theta, Eigen::Vector3d::UnitZ()};
}
Eigen::Isometry3d screw_along_x(const ChainLink& link) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() << 1, 0, 0, 0, link.cos_alpha, -link.sin_alpha, 0, link.sin_alpha, link.cos_alpha;
  result.translation().x() = link.a;
  return result;
}

}  // namespace

Chain chain_of(const RobotModel& model) {
  const NamedFrame& tool = model.frame(model.tool());
  const bool modified = model.convention() == RobotModel::Convention::modified;
  Chain chain;
  chain.joints = tool.parent_joint + 1;
  chain.dof = model.dof();
  Eigen::Isometry3d constant = Eigen::Isometry3d::Identity();  // since the joint before
  for (int i = 0; i < chain.joints; ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    if (modified) constant = constant * screw_along_x(link);
    constant = constant * screw_along_z(link);
    chain.step[static_cast<std::size_t>(i)] = {.x = lanes(constant.linear().col(0)),
                                               .y = lanes(constant.linear().col(1)),
                                               .z = lanes(constant.linear().col(2)),
                                               .origin = lanes(constant.translation()),
                                               .prismatic = link.prismatic,
                                               .independent = link.independent,
                                               .ratio = link.ratio,
                                               .offset = link.offset};
    constant = modified ? Eigen::Isometry3d::Identity() : screw_along_x(link);
  }
  constant = constant * tool.parent_T_frame;
  chain.tool_x = lanes(constant.linear().col(0));
  chain.tool_y = lanes(constant.linear().col(1));
  chain.tool_z = lanes(constant.linear().col(2));
  chain.tool_origin = lanes(constant.translation());
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

}  // namespace armature::descent
