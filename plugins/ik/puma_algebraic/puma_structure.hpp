// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "arm_kernel.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// An arm of the PUMA pattern in the one form that the equations are written for (the modified
/// Denavit-Hartenberg table of SR-1, both conventions and all signs reduced to it):
///
///   shoulder_T_wrist = Rz(t1) . Rx(-90) Tx(a1) Rz(t2) Tz(d2) . Tx(a2) Rz(t3)
///                      . Rx(-90) Tx(a3) Rz(t4) Tz(d4) . Rx(90) Rz(t5) . Rx(-90) Rz(t6)
///   base_T_tool      = base_T_shoulder . shoulder_T_wrist . wrist_T_tool
///
/// with a2 > 0. A needle (joint 6 prismatic) has t6 = 0 and moves the tool along the wrist's z.
struct PumaArm : ArmNumbers {
  double a3 = 0, d4 = 0;  // [m]; forearm and beta are their polar form
  Eigen::Isometry3d base_T_shoulder = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d wrist_T_tool = Eigen::Isometry3d::Identity();  // with the needle at 0
  /// Set when the tool lies on the axis of joint 6 and the pointing axis along it: 1 when it points
  /// the way of the wrist's z, -1 against it.
  std::optional<double> pointing;

  /// t of joint `i` (from 0) at its value q, and back.
  double canonical(std::size_t i, double q) const { return sign[i] * (q + zero[i]); }
  double joint(std::size_t i, double t) const { return sign[i] * t - zero[i]; }
};

/// `model` in this form, or the first place where it is not of the PUMA pattern: six independent
/// joints, the last one revolute or prismatic; joint 2 square to 1, 3 parallel to 2, 4 square to 3,
/// and the axes of 4, 5, 6 square to each other in turn and through one point.
Expected<PumaArm> puma_arm(const RobotModel& model);

}  // namespace armature
