// SPDX-License-Identifier: Apache-2.0
#include "puma_goal.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

using Eigen::Vector3d;

// A wrist out of reach by less than this part of the arm is on the rim of reach, and axes 4 and 6
// nearer to in line than this [rad] are in line; but never by more than the goal tolerates.
constexpr double kSlack = 1e-11, kInLine = 1e-10, kRounding = 1e-14;

Triple triple(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// `q` of joint `i` (from 0), or the nearest value within its limits; angles in [-pi, pi).
double nearest_within_limits(const PumaArm& arm, int i, double q) {
  const bool slides = arm.needle && i == 5;
  const double offset = slides ? q - arm.middle[i] : wrap_angle(q - arm.middle[i]);
  const double nearest = arm.middle[i] + std::clamp(offset, -arm.half[i], arm.half[i]);
  return slides ? nearest : wrap_angle(nearest);
}

}  // namespace

Rims rims_of(const PumaArm& arm, const IkGoal::Tolerance& tolerance) {
  const double reach = arm.a2 + arm.forearm;
  return {std::clamp(tolerance.position_m, kRounding * reach, kSlack * reach),
          std::clamp(tolerance.angle_rad, kRounding, kInLine)};
}

ArmQuestion PumaGoal::at(double depth) const {
  ArmQuestion question = at_zero;
  const Triple by{depth * needle.x, depth * needle.y, depth * needle.z};
  question.sixth = depth;
  question.wrist = {at_zero.wrist.x - by.x, at_zero.wrist.y - by.y, at_zero.wrist.z - by.z};
  question.lever = {at_zero.lever.x + by.x, at_zero.lever.y + by.y, at_zero.lever.z + by.z};
  return question;
}

PumaGoal puma_goal(const PumaArm& arm, const IkGoal& goal, const JointVector& seed) {
  const Eigen::Matrix3d shoulder_R_base = arm.base_T_shoulder.linear().transpose();
  PumaGoal result;
  ArmQuestion& question = result.at_zero;
  Vector3d axis, lever;
  if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
    axis = shoulder_R_base * (*arm.pointing * direction->unit.normalized());
    lever = arm.wrist_T_tool.translation().z() * axis;
    question.task = ArmQuestion::Task::pointing;
  } else {
    const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    const Eigen::Matrix3d shoulder_R_wrist = shoulder_R_base *
                                             rotation.normalized().toRotationMatrix() *
                                             arm.wrist_T_tool.linear().transpose();
    axis = shoulder_R_wrist.col(2);
    lever = shoulder_R_wrist * arm.wrist_T_tool.translation();
    question.n = triple(shoulder_R_wrist.col(0));
    question.o = triple(shoulder_R_wrist.col(1));
  }
  const Vector3d tool = shoulder_R_base * (goal.pose.position - arm.base_T_shoulder.translation());
  question.a = triple(axis);
  question.lever = triple(lever);
  question.wrist = triple(tool - lever);
  if (arm.needle) result.needle = triple(arm.sign[5] * axis);
  question.rims = rims_of(arm, goal.tolerance);
  const auto kept = [&](int i) {
    return wrap_angle(
        arm.canonical(static_cast<std::size_t>(i), nearest_within_limits(arm, i, seed[i])));
  };
  question.kept = {kept(0), kept(1), kept(3)};
  question.sixth = nearest_within_limits(arm, 5, seed[5]);
  return result;
}

Miss miss_of(const ArmNumbers& arm, const Triple& wrist, double side) {
  constexpr std::string_view kStretched = "the arm is stretched", kFolded = "the arm is folded";
  const double radius = std::sqrt(wrist.x * wrist.x + wrist.y * wrist.y);
  const double offset = std::abs(arm.d2), gap = radius - offset;
  // (37) has roots only beyond d2; nearer, the wrist is missed in the arm's plane, too.
  const double x = (gap > 0 ? side * std::sqrt(gap * (radius + offset)) : 0) - arm.a1;
  const double rho = std::sqrt(x * x + wrist.z * wrist.z);
  const double stretch = rho - arm.a2 - arm.forearm, fold = std::abs(arm.a2 - arm.forearm) - rho;
  const Miss plane{std::max(stretch, fold), stretch > fold ? kStretched : kFolded};
  if (gap >= 0) return plane;
  const double by = std::hypot(gap, std::max(plane.by, 0.0));
  return {by, -gap > plane.by ? "too near the axis of joint 1" : plane.why};
}

Miss min_miss(const ArmNumbers& arm, const Triple& wrist) {
  const Miss miss = miss_of(arm, wrist, 1);
  if (arm.a1 == 0) return miss;  // both reach the same
  const Miss other = miss_of(arm, wrist, -1);
  return other.by < miss.by ? other : miss;
}

}  // namespace armature
