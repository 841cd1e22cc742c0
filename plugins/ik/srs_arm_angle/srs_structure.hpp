// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// An arm of spherical shoulder, revolute elbow and spherical wrist in the one form that the
/// equations are written for:
///
///   shoulder_T_wrist = Rz(t1) Ry(t2) Rz(t3) Tz(upper) . Ry(-t4)
///                      . Rz(t5) Tz(fore) Ry(t6) Rz(t7)
///   base_T_tool      = base_T_shoulder . shoulder_T_wrist . wrist_T_tool
///
/// with `upper` and `fore` positive: the LBR Med 7 with its own joint angles.
struct SrsArm {
  double upper = 0, fore = 0;  // [m] shoulder to elbow, elbow to wrist
  std::array<double, 7> sign{1, 1, 1, 1, 1, 1, 1}, offset{};  // t = sign q + offset [rad]
  std::array<double, 7> middle{},
      half{};  // limits of t: middle +- half [rad]; half may be infinite
  Eigen::Isometry3d base_T_shoulder = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d wrist_T_tool = Eigen::Isometry3d::Identity();

  double reach() const { return upper + fore; }
  /// t of joint `i` (from 0) at its value q, and back; both in [-pi, pi).
  double canonical(std::size_t i, double q) const { return wrap_angle(sign[i] * q + offset[i]); }
  double joint(std::size_t i, double t) const { return wrap_angle(sign[i] * (t - offset[i])); }
};

/// `model` in this form, or the first place where it is not: seven independent revolute joints,
/// each square to the next, whose axes 1, 2, 3 meet in one point, 3, 4, 5 in another and 5, 6, 7
/// in a third; a tool on joint 7 and no pointing axis.
Expected<SrsArm> srs_arm(const RobotModel& model);

}  // namespace armature
