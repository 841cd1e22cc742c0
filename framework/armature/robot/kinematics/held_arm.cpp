// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/held_arm.hpp"

#include <fmt/core.h>

#include "armature/robot/kinematics/singular_values.hpp"
#include "armature/robot/kinematics/task_error.hpp"

namespace armature {
namespace {

// A hand moves by less than a millimetre in a step: Newton is there after three.
constexpr int kSteps = 8;
constexpr double kThere = 1e-10;       // [m] and [rad]
constexpr double kOfLimits = 1e-9;     // of a limit: rounding
constexpr double kLargestStep = 0.05;  // [rad] or [m] of a joint: farther off the arm is singular

const std::string& joint_name(const RobotModel& model, Eigen::Index i) {
  return model.joints()[static_cast<std::size_t>(model.independent_joint(static_cast<int>(i)))]
      .name;
}

}  // namespace

Expected<JointVector> joints_of_held_arm(const RobotModel& model, const ToolPose& pose,
                                         const JointVector& near, const JointVector& ease) {
  JointVector q = near;
  for (int i = 0; i < kSteps; ++i) {
    const TaskError missing = task_error(model, q, pose);
    if (missing.within(kThere, kThere)) {
      for (Eigen::Index j = 0; j < q.size(); ++j) {
        if (q[j] >= model.lower()[j] - kOfLimits && q[j] <= model.upper()[j] + kOfLimits) continue;
        return refuse(fmt::format("joint {} is at its limit", joint_name(model, j)));
      }
      return q;
    }
    const JointVector step = ease.cwiseProduct(
        JointVector{shortest_solution(missing.jacobian * ease.asDiagonal(), missing.error)});
    if (!step.allFinite() || step.cwiseAbs().maxCoeff() > kLargestStep) break;
    q += step;
  }
  return refuse("the arm cannot go along");
}

}  // namespace armature
