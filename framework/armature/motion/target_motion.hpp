// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/motion/goal.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// One velocity of a target, linear or angular, and how it goes on. From the velocities that were
/// told its acceleration a is estimated, and how stiffly it is held: k of v'' = -k v, which is true
/// of whatever goes round, or to and fro, with one frequency. With k = 0 the acceleration stays.
class Course {
 public:
  /// Forgets what was told before.
  void begin(const Eigen::Vector3d& velocity);
  /// `passed_s` after the last one.
  void go_on(const Eigen::Vector3d& velocity, double passed_s, double max_acceleration);

  bool moves() const { return !velocity_.isZero() || !acceleration_.isZero(); }
  /// The integral of the velocity over the next `time_s`, which may be negative.
  Eigen::Vector3d way(double time_s) const;

 private:
  void look(double max_acceleration);
  double smoothness() const;

  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();      // the newest
  Eigen::Vector3d last_look_ = Eigen::Vector3d::Zero();     // the velocity then
  Eigen::Vector3d last_change_ = Eigen::Vector3d::Zero();   // of the velocity, a second, then
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();  // `age_s_` ago
  double since_look_s_ = 0, age_s_ = 0;
  double fall_ = 0, square_ = 0;    // sums over the last looks: of -da v and of v v dt,
  double changes_ = 0, turns_ = 0;  // of squares of the changes, and of how they differ
  int looks_ = 0;
};

/// How a target that is told again and again moves. Real-time safe.
class TargetMotion {
 public:
  /// A target told longer than 0.25 s after the last one is a new one.
  void see(const MotionGoal& goal, Time now);

  bool moves() const { return linear_.moves() || angular_.moves(); }
  /// Where it will be after `time_s`, which may be negative.
  ToolPose after(double time_s) const;

 private:
  ToolPose pose_;
  Course linear_, angular_;  // [m/s], [rad/s]
  std::optional<Time> seen_;
};

}  // namespace armature
