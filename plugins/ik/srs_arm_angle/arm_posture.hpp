// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ball_joint.hpp"
#include "srs_goal.hpp"

namespace armature {

/// The shoulder, joints 1 to 3, or the wrist, joints 5 to 7, of the arms of one elbow.
struct ArmBall {
  BallJoint ball;
  std::size_t first = 0;            // index of its first joint
  double shift_a = 0, shift_c = 0;  // [rad] the joints are a + shift_a, b, c + shift_c
  double kept = 0;                  // [rad] of the first joint, where the pose leaves it free
  double in_line = 0;               // [rad]
  /// x of the ball joint is the arm angle, or of a wrist this less the arm angle [rad].
  bool wrist = false;
  double whole = 0;

  double x_at(double arm_angle) const { return wrist ? whole - arm_angle : arm_angle; }
  BallAngles angles_at(double arm_angle) const {
    return armature::angles_at(ball, SinCos::of(x_at(arm_angle)), in_line, kept - shift_a);
  }
};

/// The arms of one elbow that reach a goal: a circle, along which the arm angle runs.
struct ArmCircle {
  ArmBall shoulder, wrist;
  double t4 = 0;  // [rad]
  SinCos elbow;   // of t4
};
/// Elbow 0 has t4 >= 0, elbow 1 is -t4.
ArmCircle arm_circle(const SrsGoal& goal, int elbow);

/// The arm at one place of a circle.
struct ArmPosture {
  BallAngles shoulder, wrist;
};
inline ArmPosture posture_at(const ArmCircle& circle, double arm_angle) {
  return {circle.shoulder.angles_at(arm_angle), circle.wrist.angles_at(arm_angle)};
}

/// By how much forward kinematics at the sines and cosines found miss the goal.
PoseResidual residual_of(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                         const ArmPosture& posture);

/// What the arm angle changes of the manipulability sqrt(det J J^T) = distance upper fore
/// |sin t4| spread: |sin t2 sin t6 (t1', ..., t7')|, a dash for d/d(arm angle), since the 6 x 6
/// minors of the 6 x 7 Jacobian are the arm's motion within itself. Finite everywhere.
double spread_of(const ArmCircle& circle, const ArmPosture& posture);

/// An arm is singular when its manipulability over upper fore (upper + fore) is below.
inline constexpr double kSingular = 1e-6;
/// A singular arm: elbow straight or folded, or spread zero (t2 = 0 and t3 = +-90 degrees, t6 = 0
/// and t5 = +-90 degrees, t2 = t6 = 0).
bool is_singular(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                 const ArmPosture& posture);

}  // namespace armature
