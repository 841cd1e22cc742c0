// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// Where the slide stands among the joints.
inline constexpr std::size_t kSlide = 2;

/// A polar arm (two turns and a slide whose axes meet in one point) that carries a spherical wrist,
/// as its modified Denavit-Hartenberg rows say; alpha0 stands in the row of joint 1, as usual.
struct RrpArm {
  double l3 = 0;                          // [m] extension of the slide at d3 = 0
  double s1 = 1, s2 = 1, s4 = 1, s5 = 1;  // sines of alpha1, alpha2, alpha4, alpha5: +1 or -1
  bool across = true;                     // alpha3 = +-90 degrees; else the slide is the roll axis
  std::array<double, 6> theta{};          // [rad] offsets in [-pi, pi); that of the slide is 0
  Eigen::Matrix3d column_R_base = Eigen::Matrix3d::Identity();  // Rx(-alpha0)
  Eigen::Matrix3d wrist_R_slide = Eigen::Matrix3d::Identity();  // Rx(-alpha3) Rz(-theta3)
  // The hand is the frame of joint 6, where the wrist's axes meet.
  Eigen::Matrix3d tool_R_hand = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tool_t_hand = Eigen::Vector3d::Zero(), hand_t_tool = Eigen::Vector3d::Zero();
  std::array<double, 6> lower{}, upper{};  // [rad] or [m]
};

/// The numbers of `model` if it is such an arm, or the first place where it is not: R-R-P-R-R-R, no
/// link lengths, no offsets along axes but the slide's, alpha1, alpha2, alpha4, alpha5 = +-90
/// degrees, alpha3 a multiple of 90 degrees, and a slide that cannot reach its own axis point.
Expected<RrpArm> rrp_arm(const RobotModel& model);

}  // namespace armature
