// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/remote_centre.hpp"

namespace armature {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double RemoteCentre::deviation(const Isometry3d& base_T_tool) const {
  const Vector3d axis = base_T_tool.linear() * shaft.axis;
  return axis.cross(base_T_tool.translation() - point).norm();
}

double RemoteCentre::depth(const Isometry3d& base_T_tool) const {
  const Vector3d axis = base_T_tool.linear() * shaft.axis;
  return axis.dot(base_T_tool.translation() - point);
}

Isometry3d RemoteCentre::pivoted(const Isometry3d& base_T_tool) const {
  const Vector3d axis = base_T_tool.linear() * shaft.axis;
  const Quaterniond swing = Quaterniond::FromTwoVectors(axis, base_T_tool.translation() - point);
  const Quaterniond rotation = swing * Quaterniond{base_T_tool.linear()};
  return Eigen::Translation3d{base_T_tool.translation()} * rotation.normalized();
}

}  // namespace armature
