// SPDX-License-Identifier: Apache-2.0
#include "puma_algebraic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "branch_labels.hpp"
#include "depth_choice.hpp"
#include "free_joints.hpp"
#include "needle_reach.hpp"
#include "roll_roots.hpp"

namespace armature {
namespace {

IkStatus status_of(const IkBranches& branches) {
  const bool any =
      std::any_of(branches.begin(), branches.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

IkStatus out_of_reach(double shortfall, std::string_view detail) {
  return {IkStatus::Code::out_of_reach, shortfall, detail};
}

IkBranch& add_branch(const FourArms& arms, std::size_t arm, std::size_t wrist,
                     std::string_view label, double redundancy, IkBranches& out) {
  IkBranch& branch = out.add();
  branch.label = label;
  branch.q.resize(6);
  for (std::size_t i = 0; i < 6; ++i) {
    branch.q.data()[i] = arms.joint[wrist][i][arm];
  }
  branch.redundancy = redundancy;
  branch.residual = {arms.position_m[arm], arms.angle_rad[arm]};
  branch.within_limits = arms.margin[wrist][arm] >= 0;
  branch.singular = arms.singular[arm];
  return branch;
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> PumaAlgebraic::make(const RobotModel& model, const Params&) {
  auto arm = puma_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{new PumaAlgebraic{model, *arm}};
}

std::optional<double> PumaAlgebraic::redundancy_of(const JointVector& q) const {
  if (!arm_.pointing) return std::nullopt;
  return arm_.needle ? q[5] : wrap_angle(q[5]);
}

IkStatus PumaAlgebraic::add_branches(const ArmQuestion& question, FourArms& arms,
                                     IkBranches& out) const {
  kernel_.solve(numbers_, question, arms);
  const bool pointing = question.task == ArmQuestion::Task::pointing;
  if (!pointing) share_rolls(numbers_, arms);
  for (std::size_t i = 0; i < 8; ++i) {
    if (!arms.reached[i / 2]) continue;
    IkBranch& branch =
        add_branch(arms, i / 2, i % 2, kLabels[i], pointing ? question.sixth : 0, out);
    // What the arm cannot do at this depth it may do with the needle's help.
    if (branch.singular && arm_.needle) {
      branch.singular = manipulability(*model_, branch.q) < 1e-6;
    }
  }
  return out.count > 0 ? status_of(out) : out_of_reach(arms.shortfall, arms.detail);
}

IkStatus PumaAlgebraic::solve_at(const ArmQuestion& question, IkBranches& out) const {
  constexpr int kSteps = 64;
  FourArms arms;
  const IkStatus status = add_branches(question, arms, out);
  if (status.code != IkStatus::Code::joint_limit) return status;
  const bool free2 = std::any_of(arms.kept2, arms.kept2 + 4, [](bool kept) { return kept; });
  if (!arms.kept1 && !free2) return status;
  for (int step = 1; step <= kSteps; ++step) {
    for (const double side : {1.0, -1.0}) {
      ArmQuestion other = question;
      double& angle = arms.kept1 ? other.t1 : other.t2;
      angle = wrap_angle(angle + side * step * std::numbers::pi / kSteps);
      FourArms there;
      out.clear();
      if (add_branches(other, there, out).code == IkStatus::Code::ok) return {};
    }
  }
  out.clear();
  return add_branches(question, arms, out);
}

NeedleTask PumaAlgebraic::needle_task(const PumaGoal& goal, double beyond) const {
  return {kernel_, numbers_, goal, model_->lower()[5] - beyond, model_->upper()[5] + beyond};
}

IkStatus PumaAlgebraic::solve_line(const PumaGoal& goal, IkBranches& out) const {
  const NeedleTask task = needle_task(goal, 0);
  if (const auto miss = line_out_of_reach(task)) return out_of_reach(miss->shortfall, miss->detail);
  const double wanted = goal.at_zero.sixth;
  const IkStatus status = solve_at(goal.at(wanted), out);
  if (status.code == IkStatus::Code::ok) return status;
  const ChosenDepth chosen = choose_depth(task, wanted);
  if (!chosen.reachable) return out_of_reach(chosen.shortfall, chosen.detail);
  if (!chosen.within_limits && out.count > 0) return status;
  out.clear();
  return solve_at(goal.at(chosen.depth), out);
}

void PumaAlgebraic::add_root(const PumaGoal& goal, std::size_t arm, const RollRoots::Root& root,
                             std::array<std::size_t, 2>& found, IkBranches& out) const {
  ArmQuestion question = goal.at(root.depth);
  question.task = ArmQuestion::Task::fixed_roll;
  question.wrist_factor = std::abs(root.slope) * (arm_.a2 + arm_.forearm);
  FourArms arms;
  kernel_.solve(numbers_, question, arms);
  if (!arms.reached[arm]) return;
  // Which wrist it is, the sign of t5 tells.
  const double t5 = arm_.canonical(4, arms.joint[0][4][arm]);
  const std::size_t wrist = wrap_angle(t5) < 0 ? 1 : 0;
  add_branch(arms, arm, 0, kDepthLabels[4 * (2 * arm + wrist) + found[wrist]++], root.depth, out);
}

IkStatus PumaAlgebraic::solve_needle_rotation(const PumaGoal& goal, IkBranches& out) const {
  // A root at the very end of the range may be rounded beyond it.
  constexpr double kEnd = 1e-10;
  const NeedleTask task = needle_task(goal, kEnd);
  if (const auto miss = line_out_of_reach(task)) return out_of_reach(miss->shortfall, miss->detail);
  const RollRoots roots = roll_roots(task);
  if (roots.shortfall > 0) return out_of_reach(roots.shortfall, roots.detail);
  for (std::size_t arm = 0; arm < 4; ++arm) {
    std::array<std::size_t, 2> found{};  // of each wrist
    for (int i = 0; i < roots.of[arm].count; ++i) {
      add_root(goal, arm, roots.of[arm].root[static_cast<std::size_t>(i)], found, out);
    }
  }
  if (out.count > 0) return status_of(out);
  return {IkStatus::Code::no_convergence, roots.min_error,
          "no depth within the needle's range was found at which the roll comes right"};
}

IkStatus PumaAlgebraic::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                              IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  const bool pointing = std::holds_alternative<Direction>(goal.pose.orientation);
  if (pointing && !arm_.pointing) {
    return {IkStatus::Code::invalid_input, 0,
            "a direction needs a tool that lies on the axis of joint 6 and points along it; give a "
            "rotation"};
  }
  if (!pointing && goal.redundancy) {
    return {IkStatus::Code::invalid_input, 0, "a full rotation leaves nothing redundant"};
  }
  PumaGoal own = puma_goal(arm_, numbers_, goal, seed);
  if (arm_.needle && goal.redundancy) return solve_at(own.at(*goal.redundancy), out);
  if (arm_.needle) return pointing ? solve_line(own, out) : solve_needle_rotation(own, out);
  if (goal.redundancy) own.at_zero.sixth = wrap_angle(*goal.redundancy);
  return solve_at(own.at_zero, out);
}

}  // namespace armature

ARMATURE_PLUGIN(armature::PumaAlgebraic);
