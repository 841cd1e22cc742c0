// SPDX-License-Identifier: Apache-2.0
#include "srs_arm_angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "arm_angle_choice.hpp"
#include "armature/runtime/plugin.hpp"
#include "branches.hpp"
#include "srs_branch.hpp"

namespace armature {
namespace {

IkStatus status_of(const IkBranches& branches) {
  const bool any =
      std::any_of(branches.begin(), branches.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

/// The arms of one elbow and where they keep their limits.
struct ElbowRange {
  ArmCircle circle;
  bool t4_within_limits = false;
  std::array<Spans, 2> shoulder, wrist;

  ElbowRange(const SrsArm& arm, const SrsGoal& goal, int elbow)
      : circle{arm_circle(goal, elbow)}, t4_within_limits{within_limits(arm, 3, circle.t4)} {
    if (!t4_within_limits) return;
    shoulder = feasible_spans(arm, circle.shoulder);
    wrist = feasible_spans(arm, circle.wrist);
  }
  Spans of(const SrsArm& arm, const Flips& flips) const {
    if (!t4_within_limits) return {};
    return common_spans(arm, circle, flips, shoulder[flips.shoulder], wrist[flips.wrist]);
  }
};

/// `arm_angle`, or where that is the end of a span and rounding puts a fast joint beyond its limit,
/// a place a little further inside.
SolvedElbow solve_inside(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                         const Flips& flips, const Spans& spans, double arm_angle) {
  const SolvedElbow solved = solve_elbow(arm, goal, circle, arm_angle);
  if (branch_of(arm, solved, flips, "").within_limits) return solved;
  for (const Span& span : spans) {
    if (arm_angle < span.lower || arm_angle > span.upper) continue;
    const double inwards = 0.5 * (span.lower + span.upper) - arm_angle;
    for (const double part : {1e-9, 1e-6, 1e-3, 1.0}) {
      const SolvedElbow other = solve_elbow(arm, goal, circle, arm_angle + part * inwards);
      if (branch_of(arm, other, flips, "").within_limits) return other;
    }
  }
  return solved;
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> SrsArmAngle::make(const RobotModel& model,
                                                      const Params& params) {
  auto arm = srs_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{
      new SrsArmAngle{model, *arm, objective_from(params.text("objective"))}};
}

std::optional<double> SrsArmAngle::redundancy_of(const JointVector& q) const {
  std::array<double, 7> t;
  for (std::size_t i = 0; i < 7; ++i) t[i] = arm_.canonical(i, q.data()[i]);
  return arm_angle_of(arm_, t);
}

void SrsArmAngle::add_branches(const SrsGoal& goal, double arm_angle, IkBranches& out) const {
  const std::array<SolvedElbow, 2> elbows{solve_elbow(arm_, goal, arm_circle(goal, 0), arm_angle),
                                          solve_elbow(arm_, goal, arm_circle(goal, 1), arm_angle)};
  for (const Branch& branch : kBranches) {
    out.add() = branch_of(arm_, elbows[branch.elbow], branch.flips, branch.label);
  }
}

void SrsArmAngle::add_best_branches(const SrsGoal& goal, const JointVector& seed,
                                    std::optional<double> last, IkBranches& out) const {
  const double wanted = last ? *last : *redundancy_of(seed);
  const std::array<ElbowRange, 2> ranges{ElbowRange{arm_, goal, 0}, ElbowRange{arm_, goal, 1}};
  std::array<ArmAngleChoice, 2> choice{
      ArmAngleChoice{arm_, ranges[0].circle, objective_, wanted, last},
      ArmAngleChoice{arm_, ranges[1].circle, objective_, wanted, last}};
  for (const Branch& branch : kBranches) {
    const ElbowRange& range = ranges[branch.elbow];
    const Spans spans = range.of(arm_, branch.flips);
    const double arm_angle =
        spans.count > 0 ? choice[branch.elbow].best(branch.flips, spans) : wanted;
    const SolvedElbow solved =
        solve_inside(arm_, goal, range.circle, branch.flips, spans, arm_angle);
    out.add() = branch_of(arm_, solved, branch.flips, branch.label);
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
  const SrsGoal own = srs_goal(arm_, goal, seed);
  if (own.shortfall > 0) return {IkStatus::Code::out_of_reach, own.shortfall, own.detail};
  if (goal.redundancy) {
    add_branches(own, wrap_angle(*goal.redundancy), out);
  } else {
    std::optional<double> last = state.last_redundancy;
    if (last) last = wrap_angle(*last);
    add_best_branches(own, seed, last, out);
  }
  return status_of(out);
}

bool SrsArmAngle::feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                                      RedundancyIntervals& out) const {
  out.clear();
  if (invalid_input(*model_, goal, seed)) return false;
  const SrsGoal own = srs_goal(arm_, goal, seed);
  if (own.shortfall > 0) return false;
  const std::array<ElbowRange, 2> ranges{ElbowRange{arm_, own, 0}, ElbowRange{arm_, own, 1}};
  for (const Branch& branch : kBranches) {
    const Spans spans = ranges[branch.elbow].of(arm_, branch.flips);
    for (const Span& span : spans) out.add({branch.label, span.lower, span.upper});
  }
  return true;
}

}  // namespace armature

ARMATURE_PLUGIN(armature::SrsArmAngle);
