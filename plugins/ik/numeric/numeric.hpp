// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "descent.hpp"
#include "free_joint.hpp"
#include "ik_numeric_parameters.hpp"
#include "reach.hpp"

namespace armature::ik::numeric {

/// Iterative inverse kinematics of any arm: damped least squares from the seed, then from samples
/// of the joint space.
class Numeric final : public IkSolver {
 public:
  Numeric(const RobotModel& model, const Parameters& parameters);
  Numeric(const RobotModel& model, const Params& params)
      : Numeric{model, Parameters::read(params)} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;
  std::optional<double> redundancy_of(const JointVector& q) const override;
  bool redundancy_is_length() const override { return free_joint_ && free_joint_->slides; }

 private:
  /// What is asked for: a pose, and of some goals the value of the joint that it leaves free.
  struct Task {
    descent::Goal goal;
    std::optional<double> free_value;
    descent::JointSet locked = 0;
    int spare = 0;  // joints more than are needed
  };

  const JointVector& best_sample(const descent::Goal& goal, int restart) const;
  /// nullptr, or why the redundancy that is asked for cannot be held.
  const char* unheld_redundancy(const IkGoal& goal) const;
  /// Whether the joint that the goal leaves free can have `value`, or the same turned.
  bool is_within_limits(double value) const;
  Task task_of(const IkGoal& goal) const;
  descent::End started(const Task& task, int start, const JointVector& from) const;
  /// The joints that keep their limits all the way from a start.
  descent::JointSet bounded(const Task& task, int start) const;
  /// Where a descent got stuck with a joint at a limit: that joint jumps over the gap between its
  /// limits, to the other one. False when there is none.
  bool jump(descent::End& end) const;
  /// A redundant arm beyond its limits: locks the joint that is farthest beyond at its limit and
  /// goes down again, once for every spare joint. `end` changes only when that keeps the limits.
  void bring_inside(const Task& task, int& budget, descent::End& end) const;
  /// Where a descent got stuck nearly there: goes on to the fold of the arm that keeps it from the
  /// goal, and down again, as long as that pays.
  void settle(const IkGoal& goal, const Task& task, int& budget, descent::End& end) const;
  int worst_joint(const JointVector& q) const;
  /// Adds where a start ended; true when it keeps the limits.
  bool add_branch(const descent::End& end, std::string_view label, IkBranches& out) const;

  const RobotModel* model_;
  Parameters parameters_;
  descent::Chain chain_;
  Reach reach_;
  std::optional<FreeJoint> free_joint_;
  const descent::Kernel& kernel_;
  JointVector resting_;
  descent::JointSet turning_ = 0;     // joints for which a whole turn changes nothing
  descent::JointSet everywhere_ = 0;  // of these the ones whose limits are a whole turn apart
  std::vector<JointVector> samples_;  // of the joint space, `candidates` per restart
};

}  // namespace armature::ik::numeric
