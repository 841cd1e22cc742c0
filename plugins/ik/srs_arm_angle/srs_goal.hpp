// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"
#include "srs_structure.hpp"

namespace armature {

/// Sine and cosine of an angle.
struct SinCos {
  double sin = 0, cos = 1;

  static SinCos of(double angle) { return {std::sin(angle), std::cos(angle)}; }
  SinCos operator-() const { return {-sin, cos}; }
  SinCos operator+(const SinCos& o) const {
    return {sin * o.cos + cos * o.sin, cos * o.cos - sin * o.sin};
  }
  SinCos operator-(const SinCos& o) const { return *this + -o; }
};

/// A goal in SrsArm's form, and what of the arm does not depend on the arm angle. F, the frame in
/// which the arm angle turns, has its z along the line from shoulder to wrist and its y level:
///
///   shoulder_R_upper(psi) = F Rz(psi) Ry(-phi),  F = Rz(azimuth) Ry(polar)
///   F^T shoulder_R_wrist  = Rz(alpha) Ry(gamma) Rz(beta)
struct SrsGoal {
  Eigen::Matrix3d rotation;      // shoulder_R_wrist
  Eigen::Vector3d wrist, lever;  // [m] shoulder to wrist, wrist to tool
  double distance = 0;           // [m] shoulder to wrist
  double t4 = 0;                 // [rad] of elbow 0; elbow 1 has -t4
  SinCos elbow;                  // of t4
  SinCos phi;                    // from the upper arm to the line to the wrist, of elbow 0
  SinCos bend;                   // phi + t4
  SinCos azimuth, polar;         // of that line
  SinCos alpha, gamma, beta;     // of the hand, seen from F
  double azimuth_rad = 0, alpha_rad = 0, beta_rad = 0;
  double in_line = 0;  // [rad] axes nearer to in line are in line
  /// Somewhere on the circle of the arm angle a shoulder or a wrist is in line.
  bool shoulder_in_line = false, wrist_in_line = false;
  SinCos kept_shoulder, kept_wrist;  // of the ball joint's a, where the pose leaves t1 or t5 free
  /// How far the wrist is out of reach [m], and why.
  double shortfall = 0;
  std::string_view detail;
};

/// `goal` must be a good one (invalid_input). What the pose leaves free is kept from `seed`,
/// brought within limits.
SrsGoal srs_goal(const SrsArm& arm, const IkGoal& goal, const JointVector& seed);

/// The arm angle at the joints `q` [rad].
double arm_angle_of(const SrsArm& arm, const JointVector& q);

/// The arm angle at which the goal keeps to that of the joints `q`, which is `arm_angle`: the same,
/// but next to axis 1, where it is counted from an azimuth that turns fast or is none. There the
/// elbow stays on its side. The same everywhere where `arm_angle` is of other joints.
double kept_arm_angle(const SrsArm& arm, const JointVector& q, double arm_angle,
                      const SrsGoal& goal);

}  // namespace armature
