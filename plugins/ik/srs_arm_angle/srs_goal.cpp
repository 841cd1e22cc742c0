// SPDX-License-Identifier: Apache-2.0
#include "srs_goal.hpp"

#include <algorithm>
#include <cmath>

#include "srs_kernel.hpp"

namespace armature {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Relative to the arm's length: a gap to the rim of reach below kOnRim is rounding, a wrist nearer
// to the shoulder or to the axis of joint 1 than kOnAxis is there.
constexpr double kOnRim = 2e-15, kOnAxis = 1e-13;
// A wrist out of reach by less than this part of the arm is on the rim of reach, and axes nearer to
// in line than this [rad] are in line; but never by more than the goal tolerates.
constexpr double kSlack = 1e-11, kInLine = 1e-10, kRounding = 1e-14;
constexpr double kNextToAxis = 0.1;  // the sine of the angle between the line to a wrist and axis 1

/// Azimuth and polar angle of a direction; no azimuth on the axis.
struct Spherical {
  SinCos azimuth, polar;
};
inline Spherical spherical(const Vector3d& v, double on_axis) {
  const double radius = v.head<2>().norm(), length = v.norm();
  if (radius <= on_axis) return {{}, {0, v.z() < 0 ? -1.0 : 1.0}};
  return {{v.y() / radius, v.x() / radius}, {radius / length, v.z() / length}};
}

inline Matrix3d frame_of(const SinCos& azimuth, const SinCos& polar) {
  Matrix3d F;
  F << azimuth.cos * polar.cos, -azimuth.sin, azimuth.cos * polar.sin,  //
      azimuth.sin * polar.cos, azimuth.cos, azimuth.sin * polar.sin,    //
      -polar.sin, 0, polar.cos;
  return F;
}

/// Joints 1 to 4 of a posture: Rz(t1) Ry(t2) Rz(t3), and t4.
struct UpperArm {
  Matrix3d rotation;
  SinCos elbow;
};
UpperArm upper_arm(const SrsArm& arm, const JointVector& q) {
  const auto turn = [&](std::size_t i) { return SinCos::of(arm.canonical(i, q.data()[i])); };
  const Matrix3d F = frame_of(turn(0), turn(1));
  const SinCos third = turn(2);
  UpperArm upper{F, turn(3)};
  upper.rotation.col(0) = third.cos * F.col(0) + third.sin * F.col(1);
  upper.rotation.col(1) = third.cos * F.col(1) - third.sin * F.col(0);
  return upper;
}

/// Shoulder to wrist, seen from the upper arm.
Vector3d wrist_in_upper(const SrsArm& arm, const SinCos& t4) {
  return {-arm.fore * t4.sin, 0, arm.upper + arm.fore * t4.cos};
}

/// The direction of that: phi is its angle to the upper arm. Where the forearm folds back onto the
/// shoulder, what it comes to.
inline SinCos direction_in_upper(const SrsArm& arm, const SinCos& t4) {
  const Vector3d v = wrist_in_upper(arm, t4);
  const double length = v.norm();
  if (length < kOnAxis * arm.reach()) return {t4.sin < 0 ? 1.0 : -1.0, 0};
  return {v.x() / length, v.z() / length};
}

/// Shoulder to wrist; of a wrist on the shoulder, a unit vector of where it came from.
Vector3d wrist_or_direction(const SrsArm& arm, const UpperArm& upper) {
  const Vector3d wrist = upper.rotation * wrist_in_upper(arm, upper.elbow);
  if (wrist.norm() >= kOnAxis * arm.reach()) return wrist;
  const SinCos phi = direction_in_upper(arm, upper.elbow);
  return upper.rotation * Vector3d{phi.sin, 0, phi.cos};
}

void set_reach(const SrsArm& arm, const IkGoal::Tolerance& tolerance, SrsGoal& goal) {
  const double far = arm.reach(), near = std::abs(arm.upper - arm.fore), rho = goal.distance;
  const double slack = std::clamp(tolerance.position_m, kRounding * far, kSlack * far);
  const auto too = [&](double by, std::string_view detail) {
    if (by > slack) goal.shortfall = by, goal.detail = detail;
  };
  too(rho - far, "the arm is stretched");
  too(near - rho, "the arm is folded");
}

/// The elbow from half its angle, whose squares are factored so that nothing cancels; that is
/// returned, times a length.
SinCos set_elbow(const SrsArm& arm, SrsGoal& goal) {
  const double far = arm.reach(), near = std::abs(arm.upper - arm.fore), rho = goal.distance;
  const double outside = far - rho, inside = rho - near;
  const double up2 = outside < kOnRim * far ? 0 : outside * (far + rho);
  const double flat2 = inside < kOnRim * far ? 0 : inside * (rho + near);
  const double up = std::sqrt(up2), flat = std::sqrt(flat2), scale = 1 / (up2 + flat2);
  goal.elbow = {2 * up * flat * scale, (flat2 - up2) * scale};
  goal.phi = direction_in_upper(arm, goal.elbow);
  goal.bend = goal.phi + goal.elbow;
  return {up, flat};
}

/// The line to the wrist and the hand seen from it.
void set_frame(const SrsArm& arm, const Vector3d& along, SrsGoal& goal) {
  const Spherical line = spherical(along, kOnAxis * arm.reach());
  goal.azimuth = line.azimuth;
  goal.polar = line.polar;
  const Matrix3d hand = frame_of(line.azimuth, line.polar).transpose() * goal.rotation;
  const Spherical axis = spherical(hand.col(2), 0);
  goal.alpha = axis.azimuth;
  goal.gamma = axis.polar;
  goal.beta = {axis.azimuth.cos * hand(1, 0) - axis.azimuth.sin * hand(0, 0),
               axis.azimuth.cos * hand(1, 1) - axis.azimuth.sin * hand(0, 1)};
}

/// t4 and the angles of azimuth, alpha and beta; t4 from its half.
void set_angles(const SinCos& half_elbow, SrsGoal& goal) {
  const double sine[4]{half_elbow.sin, goal.azimuth.sin, goal.alpha.sin, goal.beta.sin};
  const double cosine[4]{half_elbow.cos, goal.azimuth.cos, goal.alpha.cos, goal.beta.cos};
  double angle[4];
  srs_kernel().angles(sine, cosine, angle);
  goal.t4 = 2 * angle[0];
  goal.azimuth_rad = angle[1];
  goal.alpha_rad = angle[2];
  goal.beta_rad = angle[3];
}

/// Whether axes come in line at x = 0 or x = pi.
bool comes_in_line(const SinCos& p, const SinCos& q, double in_line) {
  return std::min(std::abs((p + q).sin), std::abs((p - q).sin)) < 2 * in_line;
}

/// Joint `i` (from 0) of the seed, or the nearest value within its limits.
SinCos kept_from(const JointVector& seed, const SrsArm& arm, std::size_t i) {
  const double offset = wrap_angle(arm.canonical(i, seed.data()[i]) - arm.middle[i]);
  return SinCos::of(arm.middle[i] + std::clamp(offset, -arm.half[i], arm.half[i]));
}

void set_free_joints(const SrsArm& arm, const JointVector& seed, SrsGoal& goal) {
  goal.shoulder_in_line = comes_in_line(goal.polar, goal.phi, goal.in_line);
  goal.wrist_in_line = comes_in_line(goal.bend, goal.gamma, goal.in_line);
  if (goal.shoulder_in_line) goal.kept_shoulder = kept_from(seed, arm, 0) - goal.azimuth;
  if (goal.wrist_in_line) goal.kept_wrist = kept_from(seed, arm, 4);
}

Spherical line_to_wrist(const SrsArm& arm, const UpperArm& upper) {
  return spherical(wrist_or_direction(arm, upper), kOnAxis * arm.reach());
}

double arm_angle_of(const SrsArm& arm, const UpperArm& upper, const Spherical& line) {
  const SinCos phi = direction_in_upper(arm, upper.elbow);
  // The first two columns of F^T upper Ry(phi) = Rz(psi).
  const Matrix3d seen = frame_of(line.azimuth, line.polar).transpose();
  const Vector3d x = seen * (phi.cos * upper.rotation.col(0) - phi.sin * upper.rotation.col(2));
  const Vector3d y = seen * upper.rotation.col(1);
  return wrap_angle(std::atan2(x.y() - y.x(), x.x() + y.y()));
}

}  // namespace

double arm_angle_of(const SrsArm& arm, const JointVector& q) {
  const UpperArm upper = upper_arm(arm, q);
  return arm_angle_of(arm, upper, line_to_wrist(arm, upper));
}

double kept_arm_angle(const SrsArm& arm, const JointVector& q, double arm_angle,
                      const SrsGoal& goal) {
  const UpperArm upper = upper_arm(arm, q);
  const Spherical line = line_to_wrist(arm, upper);
  const SinCos& nearer = line.polar.sin < goal.polar.sin ? line.polar : goal.polar;
  if (nearer.sin >= kNextToAxis) return arm_angle;
  constexpr double kSame = 1e-6;  // [rad]
  if (std::abs(wrap_angle(arm_angle - arm_angle_of(arm, upper, line))) > kSame) return arm_angle;
  const SinCos turned = line.azimuth - goal.azimuth;
  const double by = std::atan2(turned.sin, turned.cos);
  return wrap_angle(nearer.cos < 0 ? arm_angle - by : arm_angle + by);
}

SrsGoal srs_goal(const SrsArm& arm, const IkGoal& goal, const JointVector& seed) {
  const Matrix3d shoulder_R_base = arm.base_T_shoulder.linear().transpose();
  const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
  SrsGoal own;
  own.rotation = shoulder_R_base * rotation.normalized().toRotationMatrix() *
                 arm.wrist_T_tool.linear().transpose();
  own.lever = own.rotation * arm.wrist_T_tool.translation();
  own.wrist =
      shoulder_R_base * (goal.pose.position - arm.base_T_shoulder.translation()) - own.lever;
  own.distance = own.wrist.norm();
  set_reach(arm, goal.tolerance, own);
  if (own.shortfall > 0) return own;
  const SinCos half_elbow = set_elbow(arm, own);
  const bool on_shoulder = own.distance < kOnAxis * arm.reach();
  set_frame(arm, on_shoulder ? wrist_or_direction(arm, upper_arm(arm, seed)) : own.wrist, own);
  set_angles(half_elbow, own);
  own.in_line = std::clamp(goal.tolerance.angle_rad, kRounding, kInLine);
  set_free_joints(arm, seed, own);
  return own;
}

}  // namespace armature
