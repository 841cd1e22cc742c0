// SPDX-License-Identifier: Apache-2.0
#include "reach.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

/// The longest way from one joint's frame to the next: a and d are square to each other.
double longest(const Joint& joint) {
  double d = std::abs(joint.d);
  if (joint.type == Joint::Type::prismatic) {
    d = std::max(std::abs(joint.d + joint.lower), std::abs(joint.d + joint.upper));
  }
  return std::hypot(joint.a, d);
}

}  // namespace

Reach reach_of(const RobotModel& model) {
  const auto& tool = model.frame(model.tool());
  Reach reach;
  reach.radius = tool.parent_T_frame.translation().norm();
  for (int i = 0; i <= tool.parent_joint; ++i) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(i)];
    // What the first joint does not move shifts the centre instead.
    const bool column = i == 0 && joint.type == Joint::Type::revolute &&
                        model.convention() == RobotModel::Convention::standard;
    if (column) {
      reach.centre.z() = joint.d;
      reach.radius += std::abs(joint.a);
    } else {
      reach.radius += longest(joint);
    }
  }
  return reach;
}

}  // namespace armature
