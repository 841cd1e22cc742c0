// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "task_teleoperation_parameters.hpp"

namespace armature::task::teleoperation {

/// Where the follower's tool shall be, and how fast it moves [m/s] and turns [rad/s] there, in the
/// follower's base frame.
struct FollowerTarget {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};

/// What the follower does while the clutch is closed: the hand's moves from there on, scaled, and
/// its turns, not scaled, about the same axes in space. Where the hand was before plays no part, so
/// closing the clutch moves nothing; the scale comes up smoothly. Of a hand that is too fast for
/// the follower (from four fifths of its top speed on), what is beyond is lost, as with an open
/// clutch: the follower never goes on when the hand stops. A shaft that is in an incision pivots
/// about it: the tip goes with the hand, and of the hand's turn only the roll about the shaft
/// counts. Towards the incision the tip becomes slower, as the same way is a larger tilt there, and
/// it never comes nearer than the least depth. Real-time safe.
class ScaledMotion {
 public:
  explicit ScaledMotion(const Parameters& parameters) : parameters_{parameters} {}

  /// The clutch closes with the follower and the hand there; `follower_R_leader` turns what is told
  /// in the leader's base frame into the follower's. The incision is told in the follower's.
  void engage(const Eigen::Isometry3d& follower_T_setpoint, const Eigen::Isometry3d& leader_T_hand,
              const Eigen::Matrix3d& follower_R_leader,
              const std::optional<Eigen::Vector3d>& incision = {});
  /// One period later; or so many, when the hand's poses between were missed.
  FollowerTarget follow(const Eigen::Isometry3d& leader_T_hand, int periods = 1);

 private:
  Eigen::Vector3d limited(const Eigen::Vector3d& velocity) const;

  Parameters parameters_;
  std::optional<Eigen::Vector3d> incision_;
  Eigen::Matrix3d follower_R_leader_ = Eigen::Matrix3d::Identity();
  Eigen::Isometry3d hand_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  double engaged_s_ = 0;
};

}  // namespace armature::task::teleoperation
