// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/axis_steps.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;

/// Rz(theta) Tz(d), of the constant part.
Isometry3d along_z(const ChainLink& link) {
  return Eigen::Translation3d{0, 0, link.d} *
         Eigen::AngleAxisd{link.theta, Eigen::Vector3d::UnitZ()};
}

/// Tx(a) Rx(alpha)
Isometry3d along_x(const ChainLink& link) {
  Isometry3d result = Isometry3d::Identity();
  result.linear() << 1, 0, 0, 0, link.cos_alpha, -link.sin_alpha, 0, link.sin_alpha, link.cos_alpha;
  result.translation().x() = link.a;
  return result;
}

}  // namespace

std::vector<Isometry3d> axis_steps(const RobotModel& model, FrameId frame) {
  const bool modified = model.convention() == RobotModel::Convention::modified;
  const NamedFrame& end = model.frame(frame);
  std::vector<Isometry3d> steps;
  Isometry3d constant = Isometry3d::Identity();
  for (int i = 0; i <= end.parent_joint; ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    constant = constant * link.placement;
    if (modified) constant = constant * along_x(link);
    steps.push_back(constant * along_z(link));
    constant = modified ? Isometry3d::Identity() : along_x(link);
  }
  steps.push_back(constant * end.parent_T_frame);
  return steps;
}

}  // namespace armature
