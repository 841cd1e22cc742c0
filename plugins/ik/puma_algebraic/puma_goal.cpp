// SPDX-License-Identifier: Apache-2.0
#include "puma_goal.hpp"

#include <algorithm>
#include <cmath>

#include "free_joints.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

// A wrist out of reach by less than this part of the arm is on the rim of reach, and axes 4 and 6
// nearer to in line than this [rad] are in line; but never by more than the goal tolerates.
constexpr double kSlack = 1e-11, kInLine = 1e-10, kRounding = 1e-14;

Triple triple(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

double rim_slack(const PumaArm& arm, const IkGoal::Tolerance& tolerance) {
  const double reach = arm.a2 + arm.forearm;
  return std::clamp(tolerance.position_m, kRounding * reach, kSlack * reach);
}
double in_line_angle(const IkGoal::Tolerance& tolerance) {
  return std::clamp(tolerance.angle_rad, kRounding, kInLine);
}

ArmNumbers numbers_of(const PumaArm& arm, const RobotModel& model) {
  ArmNumbers numbers{};
  numbers.a1 = arm.a1, numbers.d2 = arm.d2, numbers.a2 = arm.a2, numbers.forearm = arm.forearm;
  numbers.beta = arm.beta, numbers.cos_beta = arm.cos_beta, numbers.sin_beta = arm.sin_beta;
  numbers.needle = arm.needle;
  for (int i = 0; i < 6; ++i) {
    const auto at = static_cast<std::size_t>(i);
    numbers.sign[i] = arm.sign[at];
    numbers.zero[i] = arm.zero[at];
    const double middle = 0.5 * (model.lower()[i] + model.upper()[i]);
    numbers.half[i] = 0.5 * (model.upper()[i] - model.lower()[i]);
    // Without a limit on one side a joint that turns is never beyond the other.
    numbers.middle[i] = !std::isfinite(middle) ? 0
                        : i == 5 && arm.needle ? middle
                                               : wrap_angle(middle);
  }
  return numbers;
}

PumaGoal puma_goal(const PumaArm& arm, const ArmNumbers& numbers, const IkGoal& goal,
                   const JointVector& seed) {
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
  question.slack = rim_slack(arm, goal.tolerance);
  question.in_line = in_line_angle(goal.tolerance);
  const auto kept = [&](int i) {
    return wrap_angle(
        arm.canonical(static_cast<std::size_t>(i), nearest_within_limits(numbers, i, seed[i])));
  };
  question.t1 = kept(0);
  question.t2 = kept(1);
  question.t4 = kept(3);
  question.sixth = nearest_within_limits(numbers, 5, seed[5]);
  return result;
}

}  // namespace armature
