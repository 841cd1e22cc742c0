// SPDX-License-Identifier: Apache-2.0
#include "arm_posture.hpp"

#include <cmath>

namespace armature {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rz(a) Ry(b) Rz(c).
Matrix3d turned(const SinCos& a, const SinCos& b, const SinCos& c) {
  Matrix3d R;
  R << a.cos * b.cos * c.cos - a.sin * c.sin, -a.cos * b.cos * c.sin - a.sin * c.cos, a.cos * b.sin,
      a.sin * b.cos * c.cos + a.cos * c.sin, -a.sin * b.cos * c.sin + a.cos * c.cos, a.sin * b.sin,
      -b.sin * c.cos, b.sin * c.sin, b.cos;
  return R;
}

/// `R` Ry(-t4).
Matrix3d bent(const Matrix3d& R, const SinCos& elbow) {
  Matrix3d result;
  result.col(0) = elbow.cos * R.col(0) + elbow.sin * R.col(2);
  result.col(1) = R.col(1);
  result.col(2) = elbow.cos * R.col(2) - elbow.sin * R.col(0);
  return result;
}

/// Square of sin(b) times the length of (a', b', c').
double squared_rates(const BallJoint& ball, const BallAngles& angles) {
  const auto& [p, q] = ball;
  const auto& [a, b, c, free] = angles;
  const double along = q.sin * c.cos, across = b.sin * q.sin * c.sin;
  const double last = b.sin * q.cos - b.cos * along;
  return along * along + across * across + last * last;
}

}  // namespace

ArmCircle arm_circle(const SrsGoal& goal, int elbow) {
  const SinCos t4 = elbow == 0 ? goal.elbow : -goal.elbow;
  const SinCos phi = elbow == 0 ? goal.phi : -goal.phi;
  ArmCircle circle;
  circle.t4 = elbow == 0 ? goal.t4 : -goal.t4;
  circle.elbow = t4;
  circle.shoulder = {.ball = {goal.polar, -phi},
                     .first = 0,
                     .shift_a = goal.azimuth_rad,
                     .shift_c = 0,
                     .kept = goal.kept1,
                     .in_line = goal.in_line,
                     .wrist = false,
                     .whole = 0};
  circle.wrist = {.ball = {elbow == 0 ? goal.bend : -goal.bend, goal.gamma},
                  .first = 4,
                  .shift_a = 0,
                  .shift_c = goal.beta_rad,
                  .kept = goal.kept5,
                  .in_line = goal.in_line,
                  .wrist = true,
                  .whole = goal.alpha_rad};
  return circle;
}

PoseResidual residual_of(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                         const ArmPosture& posture) {
  const auto& [shoulder, wrist] = posture;
  const Matrix3d upper = turned(shoulder.a + goal.azimuth, shoulder.b, shoulder.c);
  const Matrix3d forearm = bent(upper, circle.elbow);
  const Matrix3d hand = forearm * turned(wrist.a, wrist.b, wrist.c + goal.beta);
  const Vector3d off = arm.upper * upper.col(2) + arm.fore * forearm.col(2) - goal.wrist;
  // From the wanted to the reached rotation.
  const Vector3d turn =
      0.5 * (goal.rotation.col(0).cross(hand.col(0)) + goal.rotation.col(1).cross(hand.col(1)) +
             goal.rotation.col(2).cross(hand.col(2)));
  return {(off + turn.cross(goal.lever)).norm(), turn.norm()};
}

double spread_of(const ArmCircle& circle, const ArmPosture& posture) {
  const auto& [shoulder, wrist] = posture;
  const double s = shoulder.b.sin, z = wrist.b.sin;
  return std::sqrt(z * z * squared_rates(circle.shoulder.ball, shoulder) +
                   s * s * squared_rates(circle.wrist.ball, wrist));
}

bool is_singular(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                 const ArmPosture& posture) {
  return goal.distance * std::abs(circle.elbow.sin) * spread_of(circle, posture) <
         kSingular * arm.reach();
}

}  // namespace armature
