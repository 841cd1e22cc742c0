// SPDX-License-Identifier: Apache-2.0
#include "srs_arm_angle.hpp"

#include <algorithm>
#include <cmath>

#include "arm_angle_choice.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

IkStatus status_of(const IkBranches& branches) {
  const bool any =
      std::any_of(branches.begin(), branches.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

/// The arm angle, or where that is the end of a span and rounding puts a fast joint beyond its
/// limit, a place a little further inside.
void move_inside(const ArmNumbers& numbers, const SrsGoal& goal, const Branch& which,
                 const Spans& spans, IkBranch& branch) {
  constexpr double kRounding = 1e-12;
  const double arm_angle = branch.redundancy;
  const int elbow = static_cast<int>(which.elbow);
  for (const Span& span : spans) {
    if (arm_angle < span.lower - kRounding || arm_angle > span.upper + kRounding) continue;
    const double inwards = 0.5 * (span.lower + span.upper) - arm_angle;
    for (const double part : {1e-9, 1e-6, 1e-3, 1.0}) {
      const double at = arm_angle + part * inwards;
      IkBranch other;
      set_branch(arms_at(numbers, goal, srs_kernel(), {{at, at}, {elbow, elbow}}), 0, which,
                 wrap_angle(at), other);
      if (!other.within_limits) continue;
      branch = other;
      return;
    }
  }
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> SrsArmAngle::make(const RobotModel& model,
                                                      const Params& params) {
  auto arm = srs_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{
      new SrsArmAngle{model, *arm, ik::srs_arm_angle::Parameters::read(params).objective}};
}

std::optional<double> SrsArmAngle::redundancy_of(const JointVector& q) const {
  return arm_angle_of(numbers_.arm, q);
}

void SrsArmAngle::add_branches(const SrsGoal& goal, double arm_angle, IkBranches& out) const {
  const TwoArms arms = arms_at(numbers_, goal, srs_kernel(), {{arm_angle, arm_angle}, {0, 1}});
  for (const Branch& branch : kBranches) {
    set_branch(arms, branch.elbow, branch, arm_angle, out.add());
  }
}

void SrsArmAngle::add_best_branches(const SrsGoal& goal, const JointVector& seed,
                                    std::optional<double> last, IkBranches& out) const {
  const SrsKernel& kernel = srs_kernel();
  const FeasibleAngles feasible{numbers_, goal, kernel};
  const Aim aim{objective_, last.has_value(), last.value_or(0)};
  const auto arm_angle = best_arm_angles(numbers_, goal, kernel, aim, seed, feasible);
  for (std::size_t i = 0; i < 8; i += 2) {  // both have one elbow
    const int elbow = static_cast<int>(kBranches[i].elbow);
    const TwoArms arms =
        arms_at(numbers_, goal, kernel, {{arm_angle[i], arm_angle[i + 1]}, {elbow, elbow}});
    for (std::size_t k = 0; k < 2; ++k) {
      const Branch& which = kBranches[i + k];
      IkBranch& branch = out.add();
      set_branch(arms, k, which, wrap_angle(arm_angle[i + k]), branch);
      if (!branch.within_limits) move_inside(numbers_, goal, which, feasible.of(i + k), branch);
    }
  }
}

IkStatus SrsArmAngle::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                            IkState& state) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  if (state.last_redundancy && !std::isfinite(*state.last_redundancy)) {
    return {IkStatus::Code::invalid_input, 0, "the last arm angle is not finite"};
  }
  const SrsGoal own = srs_goal(numbers_.arm, goal, seed);
  if (own.shortfall > 0) return {IkStatus::Code::out_of_reach, own.shortfall, own.detail};
  if (goal.redundancy) {
    add_branches(own, wrap_angle(*goal.redundancy), out);
  } else {
    std::optional<double> last = state.last_redundancy;
    if (last) last = kept_arm_angle(numbers_.arm, seed, wrap_angle(*last), own);
    add_best_branches(own, seed, last, out);
  }
  return status_of(out);
}

bool SrsArmAngle::feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                                      RedundancyIntervals& out) const {
  out.clear();
  if (invalid_input(*model_, goal, seed)) return false;
  const SrsGoal own = srs_goal(numbers_.arm, goal, seed);
  if (own.shortfall > 0) return false;
  const FeasibleAngles feasible{numbers_, own, srs_kernel()};
  for (std::size_t i = 0; i < 8; ++i) {
    const Spans spans = feasible.of(i);
    for (const Span& span : spans) out.add({kBranches[i].label, span.lower, span.upper});
  }
  return true;
}

}  // namespace armature

ARMATURE_PLUGIN(armature::SrsArmAngle);
