// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/motion/goal.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// One velocity of a target, linear or angular, and how it goes on. What was told of it is
/// filtered: the velocity, its acceleration a, and how stiffly it is held: k of v'' = -k v, which
/// is true of whatever goes round, or to and fro, with one frequency. With k = 0 the acceleration
/// stays. The more the velocities jitter, the more of them are averaged, and the less acceleration
/// and stiffness are trusted; velocities that fit one motion are taken as they are. So is one that
/// is told again and again for 30 ms: such velocities come in steps, which are no accelerations.
class Course {
 public:
  /// Forgets what was told before.
  void begin(const Eigen::Vector3d& velocity);
  /// `passed_s` after the last one.
  void go_on(const Eigen::Vector3d& told, double passed_s, double max_acceleration);

  bool moves() const { return !velocity_.isZero() || !acceleration_.isZero(); }
  /// The integral of the velocity over the next `time_s`, which may be negative.
  Eigen::Vector3d way(double time_s) const;

 private:
  void carry_on(double time_s);
  void learn(const Eigen::Vector3d& told, double max_acceleration);
  void see_jitter(const Eigen::Vector3d& told, double passed_s, double kept);
  double jitter_share() const;
  double seeming_stiffness() const;
  double stiffness() const;

  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), acceleration_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d told_ = Eigen::Vector3d::Zero();         // the newest
  Eigen::Vector3d told_before_ = Eigen::Vector3d::Zero();  // the newest other one
  double since_change_s_ = 0, last_passed_s_ = 0;  // since told_ came, and from told_before_
  double stands_s_ = 0;                            // told_ was told again for so long
  double fall_ = 0, square_ = 0;    // sums over the last changes: of -da v and of v v dt,
  double jitter_ = 0, speeds_ = 0;  // of variances of what jitters and of squares of velocities
  double learnt_s_ = 0;             // since begin
  int changes_ = 0;
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
