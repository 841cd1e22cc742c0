// SPDX-License-Identifier: Apache-2.0
#include "scaled_motion.hpp"

#include <algorithm>
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

/// The turn of a shaft from the incision, whose tip goes on from one place to another one, and that
/// rolls with the hand's turn.
Eigen::Vector3d about_incision(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                               const Eigen::Vector3d& turn) {
  const Eigen::Vector3d shaft = to.normalized();
  const Eigen::Quaterniond swing = Eigen::Quaterniond::FromTwoVectors(from, to);
  return rotation_vector_of(rotation_of(turn.dot(shaft) * shaft) * swing);
}

}  // namespace

void ScaledMotion::engage(const Eigen::Isometry3d& follower_T_setpoint,
                          const Eigen::Isometry3d& leader_T_hand,
                          const Eigen::Matrix3d& follower_R_leader,
                          const std::optional<Eigen::Vector3d>& incision) {
  incision_ = incision;
  follower_R_leader_ = follower_R_leader;
  hand_ = leader_T_hand;
  position_ = follower_T_setpoint.translation();
  rotation_ = follower_T_setpoint.linear();
  engaged_s_ = 0;
}

/// What of the hand's velocity, scaled, the tip takes.
Eigen::Vector3d ScaledMotion::limited(const Eigen::Vector3d& velocity) const {
  constexpr double kApproach_s = 0.1;  // in which the way left to the least depth is halved, nearly
  const double speed = velocity.norm();
  if (speed == 0) return velocity;
  if (!incision_) return velocity * (gently_limited(speed, parameters_.max_tip_speed) / speed);
  const Eigen::Vector3d out = position_ - *incision_;
  const double depth = out.norm();
  const double limit = std::min(parameters_.max_tip_speed, parameters_.max_tilt * depth);
  const Eigen::Vector3d slower = velocity * (gently_limited(speed, limit) / speed);
  const double inward = -slower.dot(out) / depth;
  const double may = std::max(0.0, depth - parameters_.min_depth) / kApproach_s;
  return slower + std::max(0.0, inward - may) * out / depth;
}

FollowerTarget ScaledMotion::follow(const Eigen::Isometry3d& leader_T_hand, int periods) {
  const double dt = periods * kHandPeriod_s;
  engaged_s_ += dt;
  const double engage = parameters_.engage;
  const double grip =
      engaged_s_ < engage ? Quintic::between({0, 0, 0}, {1, 0, 0}, engage).position(engaged_s_) : 1;

  const Eigen::Vector3d moved = leader_T_hand.translation() - hand_.translation();
  const Eigen::Vector3d velocity =
      limited(grip * parameters_.scale / dt * (follower_R_leader_ * moved));
  const Eigen::Vector3d position_before = position_;
  position_ += velocity * dt;

  const Eigen::Quaterniond turned{leader_T_hand.linear() * hand_.linear().transpose()};
  Eigen::Vector3d turn = grip * (follower_R_leader_ * rotation_vector_of(turned));
  if (incision_) turn = about_incision(position_before - *incision_, position_ - *incision_, turn);
  rotation_ = (rotation_of(turn) * rotation_).normalized();

  hand_ = leader_T_hand;
  return {.pose = Eigen::Translation3d{position_} * rotation_,
          .velocity = velocity,
          .angular_velocity = turn / dt};
}

}  // namespace armature::task::teleoperation
