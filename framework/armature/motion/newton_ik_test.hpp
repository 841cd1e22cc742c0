// SPDX-License-Identifier: Apache-2.0
// A solver for any arm of a test.
#pragma once

#include <algorithm>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/task_error.hpp"

namespace armature::test {

/// The solution nearest to the seed: Newton steps.
class NewtonIk : public IkSolver {
 public:
  /// Keeps a reference to `model`.
  explicit NewtonIk(const RobotModel& model) : model_{model} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    JointVector q = seed;
    for (int i = 0; i < 12; ++i) {
      const TaskError missing = task_error(model_, q, goal.pose);
      if (missing.within(1e-12, 1e-12)) {
        out.add() = branch_at(model_, goal, q, "newton");
        const bool within = out.begin()->within_limits;
        return {.code = within ? IkStatus::Code::ok : IkStatus::Code::joint_limit,
                .shortfall = 0,
                .detail = ""};
      }
      const JointVector step = missing.min_step();
      q += step * std::min(1.0, 0.3 / step.cwiseAbs().maxCoeff());
    }
    return {.code = IkStatus::Code::out_of_reach, .shortfall = 0, .detail = "Newton"};
  }

 private:
  const RobotModel& model_;
};

}  // namespace armature::test
