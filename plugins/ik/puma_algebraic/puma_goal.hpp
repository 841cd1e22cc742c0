// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/ik.hpp"
#include "four_arms.hpp"
#include "puma_structure.hpp"

namespace armature {

/// The arm and the limits of its joints in numbers.
ArmNumbers numbers_of(const PumaArm& arm, const RobotModel& model);

/// ArmQuestion::slack and ArmQuestion::in_line.
double rim_slack(const PumaArm& arm, const IkGoal::Tolerance& tolerance);
double in_line_angle(const IkGoal::Tolerance& tolerance);

/// A goal in PumaArm's form, seen from the shoulder frame.
struct PumaGoal {
  ArmQuestion at_zero;  // with the needle at 0
  Triple needle;        // what the lever grows by per metre of needle; 0 without one

  /// The same with the needle at `depth` [m].
  ArmQuestion at(double depth) const {
    ArmQuestion question = at_zero;
    const Triple by{depth * needle.x, depth * needle.y, depth * needle.z};
    question.sixth = depth;
    question.wrist = {at_zero.wrist.x - by.x, at_zero.wrist.y - by.y, at_zero.wrist.z - by.z};
    question.lever = {at_zero.lever.x + by.x, at_zero.lever.y + by.y, at_zero.lever.z + by.z};
    return question;
  }
};
/// A direction needs an arm with PumaArm::pointing. What is free is kept from `seed`, brought
/// within limits.
PumaGoal puma_goal(const PumaArm& arm, const ArmNumbers& numbers, const IkGoal& goal,
                   const JointVector& seed);

}  // namespace armature
