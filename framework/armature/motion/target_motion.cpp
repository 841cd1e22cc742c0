// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/target_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature {
namespace {

constexpr double kLongestGap_s = 0.25;
constexpr double kStands_s = 0.03;              // a velocity told anew for so long comes in steps
constexpr double kMemory_s = 0.3;               // of stiffness and jitter
constexpr double kSettling_s = 0.2;             // what goes on so briefly tells no stiffness
constexpr double kProof_s = 0.1;                // and then as if there had been none for so long
constexpr double kFine_s = 0.015;               // nearer velocities are judged as if so far apart
constexpr double kSmoothing_s = 0.02;           // of the acceleration, at least
constexpr double kSmoothness = 50;              // [1/s4] the less, the more jitter is averaged
constexpr double kDoubtful = 0.01;              // a jitter share that halves the acceleration
constexpr double kMaxStiffness = 400;           // [1/s2] 3.2 Hz
constexpr double kMaxAcceleration = 4;          // [m/s2]
constexpr double kMaxAngularAcceleration = 20;  // [rad/s2]

/// How much of what a velocity is off corrects the velocity and, times the interval, the
/// acceleration.
struct Gains {
  double velocity, acceleration;
};

/// Of the n-th velocity: the least squares over all of them while they are few, then those of a
/// critically damped filter (Brookner, Tracking and Kalman Filtering Made Easy, 1998, chapter 1).
Gains gains(int n, double passed_s, double smoothing_s) {
  const double kept = smoothing_s > 0 ? std::exp(-passed_s / smoothing_s) : 0;
  const double pairs = n * (n + 1.0);
  const double acceleration = std::max((1 - kept) * (1 - kept), 6 / pairs);
  return {.velocity = std::max(1 - kept * kept, 2 * (2 * n - 1) / pairs),
          .acceleration = std::min(acceleration, passed_s / kSmoothing_s)};
}

}  // namespace

void Course::begin(const Eigen::Vector3d& velocity) {
  *this = Course{};
  told_ = velocity_ = velocity;
}

void Course::go_on(const Eigen::Vector3d& told, double passed_s, double max_acceleration) {
  if (passed_s <= 0) return;  // the first of two at one instant counts
  carry_on(passed_s);
  since_change_s_ += passed_s;
  const bool changes = told != told_;
  const double stood_s = stands_s_ + (changes ? 0 : passed_s);
  if (stood_s >= kStands_s) {
    begin(told);
  } else if (changes) {
    learn(told, max_acceleration);
  }
  stands_s_ = changes ? 0 : stood_s;
}

void Course::carry_on(double time_s) {
  const double k = stiffness(), rate = std::sqrt(k), turned = rate * time_s;
  const double c = std::cos(turned), s = std::sin(turned);
  const Eigen::Vector3d before = velocity_;
  velocity_ = c * before + (k > 0 ? s / rate : time_s) * acceleration_;
  acceleration_ = c * acceleration_ - rate * s * before;
}

void Course::learn(const Eigen::Vector3d& told, double max_acceleration) {
  const double passed_s = std::exchange(since_change_s_, 0);
  const double kept = std::exp(-passed_s / kMemory_s);
  if (changes_++ > 0) see_jitter(told, passed_s, kept);
  const double smoothing_s = std::pow(jitter_share() * passed_s / kSmoothness, 0.2);
  const Gains gain = gains(changes_ + 1, passed_s, smoothing_s);
  const Eigen::Vector3d off = told - velocity_, change = gain.acceleration / passed_s * off;
  learnt_s_ += passed_s;
  if (changes_ > 1 && learnt_s_ > kSettling_s) {
    if (square_ == 0) square_ = kProof_s * told.squaredNorm();
    const double square = velocity_.squaredNorm() * passed_s;
    fall_ = kept * fall_ + stiffness() * square - change.dot(velocity_);
    square_ = kept * square_ + square;
  }
  velocity_ += gain.velocity * off;
  acceleration_ += change;
  const double size = acceleration_.norm();
  if (size > max_acceleration) acceleration_ *= max_acceleration / size;
  told_before_ = std::exchange(told_, told);
  last_passed_s_ = passed_s;
}

/// Jitter is what three velocities in a row are off a straight line, or off the bend that the
/// stiffness explains.
void Course::see_jitter(const Eigen::Vector3d& told, double passed_s, double kept) {
  const double forward = passed_s / last_passed_s_;
  const Eigen::Vector3d line = told_ + forward * (told_ - told_before_);
  const double bend = 0.5 * seeming_stiffness() * passed_s * (passed_s + last_passed_s_);
  const double parts = 1 + (1 + forward) * (1 + forward) + forward * forward;
  jitter_ = kept * jitter_ + (told - line + bend * told_).squaredNorm() / parts;
  speeds_ = kept * speeds_ + told.squaredNorm();
}

double Course::jitter_share() const { return speeds_ > 0 ? jitter_ / speeds_ : 0; }

double Course::seeming_stiffness() const {
  return fall_ > 0 ? std::min(fall_ / square_, kMaxStiffness) : 0;
}

/// It counts the less, the farther velocities are off a straight line for the stiffest target.
double Course::stiffness() const {
  const double bend = kMaxStiffness * std::pow(std::max(last_passed_s_, kFine_s), 2);
  return seeming_stiffness() / (1 + 6 * jitter_share() / (bend * bend));
}

Eigen::Vector3d Course::way(double time_s) const {
  const Eigen::Vector3d acceleration = acceleration_ / (1 + jitter_share() / kDoubtful);
  const double k = stiffness(), rate = std::sqrt(k), turned = rate * time_s;
  if (std::abs(turned) < 1e-3) return velocity_ * time_s + acceleration * (0.5 * time_s * time_s);
  return velocity_ * (std::sin(turned) / rate) + acceleration * ((1 - std::cos(turned)) / k);
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
