// SPDX-License-Identifier: Apache-2.0
#include "rrp_zyz.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "armature/runtime/plugins/plugin.hpp"
#include "turns_on_limits.hpp"

namespace armature {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// Base 0: sin(theta2) >= 0. Wrist 0: sin(theta5) >= 0.
constexpr std::array<std::string_view, 4> kLabels{"base0/wrist0", "base0/wrist1", "base1/wrist0",
                                                  "base1/wrist1"};

// A sine below this is rounding: the angle that it leaves open is the seed's.
constexpr double kFree = 1e-12;
// Below this the sine in det J = d^2 sin(theta2) sin(theta5) counts as zero.
constexpr double kSingular = 1e-6;
// Rounding moves a goal at the end of the slide by this much of its extension.
constexpr double kBeyondSlide = 1e-12;
constexpr double kLimitTolerance = 1e-9;  // that of `unwind`

/// An angle with its sine and cosine; half a turn on and the mirror images are exact.
struct Angle {
  double value, sin, cos;

  static Angle of(double value) { return {wrap_angle(value), std::sin(value), std::cos(value)}; }
  /// From a pair of unit length.
  static Angle from(double sin, double cos) { return {std::atan2(sin, cos), sin, cos}; }

  Angle half_turn_on() const { return {value > 0 ? value - kPi : value + kPi, -sin, -cos}; }
  Angle negative() const { return {-value, -sin, cos}; }
  /// pi - angle.
  Angle across() const { return {value > 0 ? kPi - value : -kPi - value, sin, -cos}; }
};

/// The joints of the arm up to the slide, as Denavit-Hartenberg angles.
struct Base {
  Angle theta1, theta2;
  bool free;  // axis 1 runs along the slide: theta1 is given
};

/// The joints behind the slide.
struct Wrist {
  Angle theta4, theta5, theta6;
  bool free;  // axes 4 and 6 are one: theta4 is the seed's

  Wrist flipped() const {
    return {theta4.half_turn_on(), theta5.negative(), theta6.half_turn_on(), free};
  }
};

/// column_R_slide = Rz(theta1) Rx(alpha1) Rz(theta2) Rx(alpha2); its last column is the slide.
Matrix3d slide_rotation(const RrpArm& arm, const Base& base) {
  const Angle &t1 = base.theta1, &t2 = base.theta2;
  const double e = arm.s1 * arm.s2;
  Matrix3d R;
  R << t1.cos * t2.cos, t1.sin * e, t1.cos * arm.s2 * t2.sin,  //
      t1.sin * t2.cos, -t1.cos * e, t1.sin * arm.s2 * t2.sin,  //
      arm.s1 * t2.sin, 0, -e * t2.cos;
  return R;
}

/// Rz(theta4) Rx(alpha4) Rz(theta5) Rx(alpha5) Rz(theta6).
Matrix3d wrist_rotation(const RrpArm& arm, const Wrist& wrist) {
  const Angle &t4 = wrist.theta4, &t5 = wrist.theta5, &t6 = wrist.theta6;
  const double e = arm.s4 * arm.s5;
  const double x1 = t5.cos * t6.cos, x2 = -t5.cos * t6.sin;
  const double y1 = -e * t6.sin, y2 = -e * t6.cos;
  Matrix3d R;
  R << t4.cos * x1 - t4.sin * y1, t4.cos * x2 - t4.sin * y2, t4.cos * arm.s5 * t5.sin,  //
      t4.sin * x1 + t4.cos * y1, t4.sin * x2 + t4.cos * y2, t4.sin * arm.s5 * t5.sin,   //
      arm.s4 * t5.sin * t6.cos, -arm.s4 * t5.sin * t6.sin, -e * t5.cos;
  return R;
}

/// theta1, theta2 (base 0) that lay the slide through `p`, `distance` away from the centre; theta1
/// is `free_theta1` where any does.
Base solve_base(const RrpArm& arm, const Vector3d& p, double distance, double free_theta1) {
  const double radius = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const double cos2 = -arm.s1 * arm.s2 * p.z() / distance;
  if (radius <= kFree * distance) {
    return {Angle::of(free_theta1), Angle::from(0, std::copysign(1.0, cos2)), true};
  }
  return {Angle::from(arm.s2 * p.y() / radius, arm.s2 * p.x() / radius),
          Angle::from(radius / distance, cos2), false};
}

/// The joint's value in [-pi, pi) for a Denavit-Hartenberg angle in [-pi, pi].
double joint_value(const RrpArm& arm, std::size_t joint, const Angle& theta) {
  const double value = theta.value - arm.theta[joint];
  if (value >= kPi) return value - 2 * kPi;
  return value < -kPi ? value + 2 * kPi : value;
}

/// theta6 after theta4, from the row of Rz(-theta4) M that theta5 leaves alone: it has length 1, so
/// that an error of theta4 next to the singular pose is taken back.
Angle last_turn(const RrpArm& arm, const Matrix3d& M, const Angle& t4) {
  const double e = arm.s4 * arm.s5;
  return Angle::from(-e * (t4.cos * M(1, 0) - t4.sin * M(0, 0)),
                     -e * (t4.cos * M(1, 1) - t4.sin * M(0, 1)));
}

bool within(const RrpArm& arm, std::size_t joint, double value) {
  return value >= arm.lower[joint] - kLimitTolerance && value <= arm.upper[joint] + kLimitTolerance;
}

/// theta4 of a singular wrist: the seed's; where joint 6 would leave its limits, the one that puts
/// it on the nearer limit, or else on the other.
Angle free_turn(const RrpArm& arm, const Matrix3d& M, double seed_theta4) {
  const Angle wanted = Angle::of(seed_theta4);
  const double q6 = joint_value(arm, 5, last_turn(arm, M, wanted));
  if (within(arm, 5, q6)) return wanted;
  const bool low_first =
      std::abs(wrap_angle(q6 - arm.lower[5])) < std::abs(wrap_angle(q6 - arm.upper[5]));
  for (const bool low : {low_first, !low_first}) {
    const double turn = wrap_angle((low ? arm.lower[5] : arm.upper[5]) - q6);
    for (const double sign : {1.0, -1.0}) {  // joints 4 and 6 turn the same or opposite ways
      const Angle moved = Angle::of(seed_theta4 + sign * turn);
      if (within(arm, 5, joint_value(arm, 5, last_turn(arm, M, moved))) &&
          within(arm, 3, joint_value(arm, 3, moved))) {
        return moved;
      }
    }
  }
  return wanted;
}

/// theta4 to theta6 (wrist 0) that make the wrist's rotation M.
Wrist solve_wrist(const RrpArm& arm, const Matrix3d& M, double seed_theta4) {
  const double s = std::sqrt(M(0, 2) * M(0, 2) + M(1, 2) * M(1, 2));
  const double e = arm.s4 * arm.s5, cos5 = -e * M(2, 2);
  Wrist wrist;
  wrist.free = s <= kFree;
  if (wrist.free) {
    wrist.theta4 = free_turn(arm, M, seed_theta4);
    wrist.theta5 = Angle::from(0, std::copysign(1.0, cos5));
  } else {
    wrist.theta4 = Angle::from(arm.s5 * M(1, 2) / s, arm.s5 * M(0, 2) / s);
    wrist.theta5 = Angle::from(s, cos5);
  }
  wrist.theta6 = last_turn(arm, M, wrist.theta4);
  return wrist;
}

/// One goal on its way through the solver.
struct Problem {
  const RrpArm& arm;
  const JointVector& seed;
  Vector3d centre;         // of the wrist, seen from the column (alpha0 turned away)
  Matrix3d column_R_hand;  // joint 6
  double distance;         // |centre| = d3 + l3
  IkBranches& out;
};

/// M = wrist_R_slide column_R_slide^T column_R_hand.
Matrix3d wrist_goal(const Problem& p, const Base& base) {
  return p.arm.wrist_R_slide * (slide_rotation(p.arm, base).transpose() * p.column_R_hand);
}

/// Position and angle error of the tool at the sines and cosines that were found. Branches that are
/// mirror images have the same ones, so their errors are the same.
PoseResidual residual_of(const Problem& p, const Base& base, const Wrist& wrist,
                         const Matrix3d& M) {
  const Matrix3d column_R_slide = slide_rotation(p.arm, base);
  const Matrix3d turn = wrist_rotation(p.arm, wrist) - M;
  const Vector3d swing = p.arm.wrist_R_slide.transpose() * (turn * p.arm.hand_t_tool);
  const Vector3d shift = p.distance * column_R_slide.col(2) - p.centre + column_R_slide * swing;
  // |R1 - R2| = 2 sqrt(2) sin(angle / 2) in the Frobenius norm.
  return {shift.norm(), 2 * std::asin(std::min(turn.norm() / std::sqrt(8.0), 1.0))};
}

/// What `unwind` answers, without turning.
bool keeps_limits(const RrpArm& arm, const JointVector& q) {
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    const double lower = arm.lower[i] - kLimitTolerance, upper = arm.upper[i] + kLimitTolerance;
    if (value >= lower && value <= upper) continue;
    if (i == kSlide) return false;
    if (value + 2 * kPi * std::ceil((lower - value) / (2 * kPi)) > upper) return false;
  }
  return true;
}

void add_branch(Problem& p, std::size_t label, const Base& base, const Wrist& wrist,
                const PoseResidual& residual) {
  IkBranch& branch = p.out.add();
  branch.label = kLabels[label];
  branch.q.resize(6);
  branch.q << joint_value(p.arm, 0, base.theta1), joint_value(p.arm, 1, base.theta2),
      p.distance - p.arm.l3, joint_value(p.arm, 3, wrist.theta4),
      joint_value(p.arm, 4, wrist.theta5), joint_value(p.arm, 5, wrist.theta6);
  branch.redundancy = 0;
  branch.residual = residual;
  branch.within_limits = keeps_limits(p.arm, branch.q);
  branch.singular = std::abs(base.theta2.sin) < kSingular || std::abs(wrist.theta5.sin) < kSingular;
}

/// All four branches; where axis 1 runs along the slide, theta1 of base 0 is `free_theta1`. True
/// when it does.
bool solve_at(Problem& p, double free_theta1) {
  p.out.clear();
  const double seed4 = p.seed[3] + p.arm.theta[3];
  const Base base = solve_base(p.arm, p.centre, p.distance, free_theta1);
  const Matrix3d M = wrist_goal(p, base);
  const Wrist wrist = solve_wrist(p.arm, M, seed4);
  const PoseResidual residual = residual_of(p, base, wrist, M);
  add_branch(p, 0, base, wrist, residual);
  add_branch(p, 1, base, wrist.flipped(), residual);

  // Half a turn of joint 1 and the mirrored joint 2 lay the slide on the same line, turned by pi.
  const Base other{base.theta1.half_turn_on(), base.theta2.negative(), base.free};
  Wrist turned = wrist;
  PoseResidual error = residual;
  if (wrist.free) {
    const Matrix3d other_M = wrist_goal(p, other);
    turned = solve_wrist(p.arm, other_M, seed4);
    error = residual_of(p, other, turned, other_M);
  } else if (p.arm.across) {  // Ry(pi) M
    turned = {wrist.theta4.across(), wrist.theta5.across(), wrist.theta6.half_turn_on(), false};
  } else {  // Rz(pi) M
    turned.theta4 = wrist.theta4.half_turn_on();
  }
  add_branch(p, 2, other, turned, error);
  add_branch(p, 3, other, turned.flipped(), error);
  return base.free;
}

bool any_within_limits(const IkBranches& branches) {
  return std::ranges::any_of(branches, &IkBranch::within_limits);
}

/// The wrist's rotation over a turn of a base whose axis 1 runs along the slide.
TurningWrist turning_wrist(const Problem& p) {
  std::array<Matrix3d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) {
    const double theta1 = static_cast<double>(i) * kPi / 2;
    at[i] = wrist_goal(p, solve_base(p.arm, p.centre, p.distance, theta1));
  }
  return {at[0], at[1], at[2]};
}

/// A free theta1 is the seed's; where no branch keeps the limits there, the nearest at which one
/// does. False: there is none, and the branches are those of the seed.
bool solve_all(Problem& p) {
  const double seed1 = p.seed[0] + p.arm.theta[0];
  const bool free = solve_at(p, seed1);
  if (any_within_limits(p.out)) return true;
  if (!free) return false;
  TurnsOnLimits turns = turns_on_limits(p.arm, turning_wrist(p));
  const auto way = [&](double theta1) { return std::abs(wrap_angle(theta1 - seed1)); };
  std::ranges::sort(turns.begin(), turns.end(), {}, way);
  for (const double theta1 : turns) {
    solve_at(p, theta1);
    if (any_within_limits(p.out)) return true;
  }
  solve_at(p, seed1);
  return false;
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> RrpZyz::make(const RobotModel& model, const Params&) {
  auto arm = rrp_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{new RrpZyz{model, *arm}};
}

IkStatus RrpZyz::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                       IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  // The robot has no pointing axis, so the goal is a rotation.
  const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
  const Matrix3d column_R_tool = arm_.column_R_base * rotation.normalized().toRotationMatrix();
  const Vector3d centre =
      arm_.column_R_base * goal.pose.position + column_R_tool * arm_.tool_t_hand;
  const double distance = centre.norm();
  const double most = arm_.upper[kSlide] + arm_.l3, least = arm_.lower[kSlide] + arm_.l3;
  if (distance > most * (1 + kBeyondSlide)) {
    return {IkStatus::Code::out_of_reach, distance - most, "the slide is too short"};
  }
  if (distance < least * (1 - kBeyondSlide)) {
    return {IkStatus::Code::out_of_reach, least - distance, "the slide does not go in so far"};
  }
  Problem problem{arm_, seed, centre, column_R_tool * arm_.tool_R_hand, distance, out};
  if (solve_all(problem)) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

}  // namespace armature

ARMATURE_PLUGIN(armature::RrpZyz);
