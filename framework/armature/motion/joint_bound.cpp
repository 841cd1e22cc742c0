// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/joint_bound.hpp"

#include <cmath>
#include <cstddef>

namespace armature {

JointVector each(const JointBound& bound, const RobotModel& model) {
  JointVector values(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    values[i] = model.is_revolute(i) ? bound.turning_rad : bound.sliding_m;
  }
  return values;
}

bool is_near(const RobotModel& model, const JointVector& a, const JointVector& b,
             const JointBound& bound) {
  return ((a - b).cwiseAbs().array() <= each(bound, model).array()).all();
}

ReasonText tolerance_violation(const RobotModel& model, const JointVector& q,
                               const JointTarget& target, const JointBound& bound) {
  for (int i = 0; i < model.dof(); ++i) {
    const bool turns = model.is_revolute(i);
    const double most = turns ? bound.turning_rad : bound.sliding_m;
    const double away = std::abs(q[i] - target.q[i]);
    if (away <= most) continue;
    const char* unit = turns ? "rad" : "m";
    const auto joint = static_cast<std::size_t>(model.independent_joint(i));
    return ReasonText::format("joint {} of the arm is {:.4g} {} away from {} ({}_{} is {:g})",
                              model.joints()[joint].name, away, unit, target.name,
                              target.bound_name, unit, most);
  }
  return {};
}

}  // namespace armature
