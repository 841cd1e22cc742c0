// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/target_motion.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature {
namespace {

constexpr double kLongestGap_s = 0.25;
constexpr double kLook_s = 0.015;               // between velocities that are compared
constexpr double kSmoothing_s = 0.02;           // of the acceleration
constexpr double kMemory_s = 0.3;               // of the stiffness
constexpr double kMaxStiffness = 400;           // [1/s2] 3.2 Hz
constexpr double kMaxAcceleration = 4;          // [m/s2]
constexpr double kMaxAngularAcceleration = 20;  // [rad/s2]

}  // namespace

void Course::begin(const Eigen::Vector3d& velocity) {
  *this = Course{};
  velocity_ = last_look_ = velocity;
}

void Course::go_on(const Eigen::Vector3d& velocity, double passed_s, double max_acceleration) {
  velocity_ = velocity;
  since_look_s_ += passed_s;
  age_s_ += passed_s;
  if (since_look_s_ >= kLook_s) look(max_acceleration);
}

void Course::look(double max_acceleration) {
  const Eigen::Vector3d before = acceleration_;
  const Eigen::Vector3d change = (velocity_ - last_look_) / since_look_s_;
  // A velocity that is told in steps jumps after it has stood: that is no acceleration.
  const bool jumps = looks_ > 0 && last_change_.norm() < 0.1 * change.norm();
  acceleration_ = jumps ? Eigen::Vector3d::Zero() : change;
  const double kept = std::exp(-since_look_s_ / kMemory_s);
  if (looks_ > 0) {
    changes_ = kept * changes_ + change.squaredNorm();
    turns_ = kept * turns_ + (change - last_change_).squaredNorm();
  }
  last_change_ = change;
  age_s_ = since_look_s_ / 2;
  if (looks_++ > 0) {
    acceleration_ += kSmoothing_s / (since_look_s_ + kSmoothing_s) * (before - acceleration_);
    age_s_ += kSmoothing_s;
    fall_ = kept * fall_ - (acceleration_ - before).dot(last_look_);
    square_ = kept * square_ + last_look_.squaredNorm() * since_look_s_;
  }
  const double size = acceleration_.norm();
  if (size > max_acceleration) acceleration_ *= max_acceleration / size;
  last_look_ = velocity_;
  since_look_s_ = 0;
}

/// The share of the velocity's changes that is the target's own, 0 to 1; the rest is jitter. The
/// squared difference of two changes in a row is three times the square of a change where
/// velocities only jitter. Where the target goes round it is (angle between two looks)^2 times that
/// square, which counts as no jitter up to 0.5 rad.
double Course::smoothness() const {
  constexpr double kRound = 0.25;  // [rad2]
  return changes_ > 0 ? std::clamp((3 - turns_ / changes_) / (3 - kRound), 0.0, 1.0) : 1;
}

Eigen::Vector3d Course::way(double time_s) const {
  const double smooth = smoothness();
  const double stiffness = fall_ > 0 ? smooth * std::min(fall_ / square_, kMaxStiffness) : 0;
  const Eigen::Vector3d now = smooth * acceleration_ - stiffness * age_s_ * velocity_;
  const double rate = std::sqrt(stiffness), turned = rate * time_s;
  if (std::abs(turned) < 1e-3) return velocity_ * time_s + now * (0.5 * time_s * time_s);
  return velocity_ * (std::sin(turned) / rate) + now * ((1 - std::cos(turned)) / stiffness);
}

void TargetMotion::see(const MotionGoal& goal, Time now) {
  const double passed_s = seen_ ? to_seconds(now - *seen_) : 2 * kLongestGap_s;
  seen_ = now;
  pose_ = goal.pose;
  if (passed_s < 0 || passed_s > kLongestGap_s) {
    linear_.begin(goal.velocity);
    angular_.begin(goal.angular_velocity);
  } else {
    linear_.go_on(goal.velocity, passed_s, kMaxAcceleration);
    angular_.go_on(goal.angular_velocity, passed_s, kMaxAngularAcceleration);
  }
}

ToolPose TargetMotion::after(double time_s) const {
  ToolPose pose = pose_;
  pose.position += linear_.way(time_s);
  const Eigen::Quaterniond turn = rotation_of(angular_.way(time_s));
  if (auto* direction = std::get_if<Direction>(&pose.orientation)) {
    direction->unit = turn * direction->unit;
  } else {
    pose.orientation = turn * std::get<Eigen::Quaterniond>(pose.orientation);
  }
  return pose;
}

}  // namespace armature
