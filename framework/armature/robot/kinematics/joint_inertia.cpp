// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/joint_inertia.hpp"

#include <algorithm>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {

JointInertia joint_inertia(const RobotModel& model, const JointVector& q) {
  JointInertia inertia = JointInertia::Zero(model.dof(), model.dof());
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const ChainLink& link = model.chain()[i];
    inertia(link.independent, link.independent) +=
        link.ratio * link.ratio * model.joints()[i].drive_inertia;
  }
  for (const LinkMass& mass : model.masses()) {
    const Jacobian jacobian = point_jacobian(model, q, mass.parent_joint, mass.centre);
    inertia += mass.mass * jacobian.topRows<3>().transpose() * jacobian.topRows<3>();
  }
  return inertia;
}

double felt_length(const RobotModel& model, const JointVector& way, const JointVector& to) {
  return std::sqrt(std::max(0.0, way.dot(joint_inertia(model, to) * way)));
}

}  // namespace armature
