// SPDX-License-Identifier: Apache-2.0
#include "scaled_motion.hpp"

#include <cmath>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/trajectories/quintic.hpp"
#include "hand_period.hpp"

namespace armature::task::teleoperation {
namespace {

/// `speed` up to four fifths of `limit`, from there on smoothly less and never more than it: a
/// sharp corner would be overshot by the follower.
double gently_limited(double speed, double limit) {
  constexpr double kKnee = 0.8;
  const double part = speed / limit;
  if (part <= kKnee) return speed;
  return limit * (kKnee + (1 - kKnee) * std::tanh((part - kKnee) / (1 - kKnee)));
}

}  // namespace

void ScaledMotion::engage(const Eigen::Isometry3d& follower_T_tool,
                          const Eigen::Isometry3d& leader_T_hand,
                          const Eigen::Matrix3d& follower_R_leader) {
  follower_R_leader_ = follower_R_leader;
  hand_ = leader_T_hand;
  position_ = follower_T_tool.translation();
  rotation_ = follower_T_tool.linear();
  engaged_s_ = 0;
}

FollowerTarget ScaledMotion::follow(const Eigen::Isometry3d& leader_T_hand, int periods) {
  const double dt = periods * kHandPeriod_s;
  engaged_s_ += dt;
  const double engage = parameters_.engage;
  const double grip =
      engaged_s_ < engage ? Quintic::between({0, 0, 0}, {1, 0, 0}, engage).position(engaged_s_) : 1;

  const Eigen::Vector3d moved = leader_T_hand.translation() - hand_.translation();
  Eigen::Vector3d velocity = grip * parameters_.scale / dt * (follower_R_leader_ * moved);
  const double speed = velocity.norm();
  if (speed > 0) velocity *= gently_limited(speed, parameters_.max_tip_speed) / speed;
  position_ += velocity * dt;

  const Eigen::Quaterniond turned{leader_T_hand.linear() * hand_.linear().transpose()};
  const Eigen::Vector3d turn = grip * (follower_R_leader_ * rotation_vector_of(turned));
  rotation_ = (rotation_of(turn) * rotation_).normalized();

  hand_ = leader_T_hand;
  return {.pose = Eigen::Translation3d{position_} * rotation_,
          .velocity = velocity,
          .angular_velocity = turn / dt};
}

}  // namespace armature::task::teleoperation
