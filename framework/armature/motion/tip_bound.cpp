// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/tip_bound.hpp"

#include <Eigen/Geometry>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {

ReasonText tip_violation(const RobotModel& model, const JointVector& q, const JointVector& wanted,
                         double max_m) {
  const Eigen::Isometry3d is = forward_kinematics(model, q);
  const Eigen::Isometry3d shall_be = forward_kinematics(model, wanted);
  const auto said = [&](const char* what, double away_m) {
    return ReasonText::format(
        "the {} of the arm is {:.4g} mm away from the reference (max_tip_deviation_m is {:g})",
        what, 1e3 * away_m, max_m);
  };
  const double tip_m = (is.translation() - shall_be.translation()).norm();
  if (!(tip_m <= max_m)) return said("tip", tip_m);
  if (!model.shaft()) return {};
  const Eigen::Vector3d end = -model.shaft()->length * model.shaft()->axis;
  const double end_m = (is * end - shall_be * end).norm();
  if (!(end_m <= max_m)) return said("shaft's end", end_m);
  return {};
}

}  // namespace armature
