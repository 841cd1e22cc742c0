// SPDX-License-Identifier: Apache-2.0
#include "srs_arm_angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "arm_angle_choice.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "branches.hpp"
#include "feasible_angles.hpp"
#include "ik_srs_arm_angle_parameters.hpp"
#include "srs_branch.hpp"

namespace armature {
namespace {

using ik::srs_arm_angle::Parameters;

Objective objective_of(const Parameters& parameters) {
  switch (parameters.objective) {
    case Parameters::Objective::limits:
      return Objective::limits;
    case Parameters::Objective::singularity:
      return Objective::singularity;
    case Parameters::Objective::continuity:
      return Objective::continuity;
    case Parameters::Objective::balanced:
      break;
  }
  return Objective::balanced;
}

IkStatus status_of(const IkBranches& branches) {
  const bool any =
      std::any_of(branches.begin(), branches.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

/// `arm_angle`, or where that is the end of a span and rounding puts a fast joint beyond its limit,
/// a place a little further inside.
IkBranch branch_inside(const SrsArm& arm, const SrsGoal& goal, const Branch& branch,
                       const Spans& spans, double arm_angle) {
  const ArmCircle circle = arm_circle(goal, static_cast<int>(branch.elbow));
  const auto at = [&](double place) {
    return branch_of(arm, solve_elbow(arm, goal, circle, place), branch.flips, branch.label);
  };
  const IkBranch found = at(arm_angle);
  if (found.within_limits) return found;
  for (const Span& span : spans) {
    if (arm_angle < span.lower || arm_angle > span.upper) continue;
    const double inwards = 0.5 * (span.lower + span.upper) - arm_angle;
    for (const double part : {1e-9, 1e-6, 1e-3, 1.0}) {
      const IkBranch other = at(arm_angle + part * inwards);
      if (other.within_limits) return other;
    }
  }
  return found;
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> SrsArmAngle::make(const RobotModel& model,
                                                      const Params& params) {
  auto arm = srs_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{
      new SrsArmAngle{model, *arm, objective_of(Parameters::read(params))}};
}

std::optional<double> SrsArmAngle::redundancy_of(const JointVector& q) const {
  std::array<double, 7> t{};
  for (std::size_t i = 0; i < 4; ++i) t[i] = numbers_.arm.canonical(i, q.data()[i]);
  return arm_angle_of(numbers_.arm, t);
}

void SrsArmAngle::add_branches(const SrsGoal& goal, double arm_angle, IkBranches& out) const {
  EightBranches found;
  srs_kernel().turn_to(numbers_, goal, arm_angle, found);
  std::array<SolvedElbow, 2> elbows;
  std::array<bool, 2> solved{};
  for (std::size_t i = 0; i < kBranches.size(); ++i) {
    const Branch& branch = kBranches[i];
    if ((found.in_line >> i & 1) == 0) {
      set_branch(found, i, arm_angle, branch.label, out.add());
      continue;
    }
    const std::size_t elbow = branch.elbow;
    if (!std::exchange(solved[elbow], true)) {
      elbows[elbow] =
          solve_elbow(numbers_.arm, goal, arm_circle(goal, static_cast<int>(elbow)), arm_angle);
    }
    out.add() = branch_of(numbers_.arm, elbows[elbow], branch.flips, branch.label);
  }
}

void SrsArmAngle::add_best_branches(const SrsGoal& goal, const JointVector& seed,
                                    std::optional<double> last, IkBranches& out) const {
  const SrsKernel& kernel = srs_kernel();
  const FeasibleAngles feasible{numbers_, goal, kernel};
  std::array<Spans, 8> spans;
  for (std::size_t i = 0; i < 8; ++i) feasible.of_elbow0(kBranches[i], spans[i]);
  const Aim aim{objective_, last.has_value(), last.value_or(0)};
  std::array<double, 8> arm_angle;
  ArmAngleChoice{numbers_, goal, kernel, aim, seed}.choose(spans, arm_angle);
  EightPlaces at;
  std::copy(arm_angle.begin(), arm_angle.end(), at.arm_angle);
  std::iota(at.branch, at.branch + 8, 0);
  EightBranches found;
  kernel.turn_each(numbers_, goal, at, found);
  for (std::size_t i = 0; i < 8; ++i) {
    const bool inside = (found.within_limits >> i & 1) != 0 || spans[i].count == 0;
    if (inside && (found.in_line >> i & 1) == 0) {
      set_branch(found, i, wrap_angle(arm_angle[i]), kBranches[i].label, out.add());
    } else {
      out.add() =
          branch_inside(numbers_.arm, goal, kBranches[i], feasible.of(kBranches[i]), arm_angle[i]);
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
    if (last) last = wrap_angle(*last);
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
  for (const Branch& branch : kBranches) {
    const Spans spans = feasible.of(branch);
    for (const Span& span : spans) out.add({branch.label, span.lower, span.upper});
  }
  return true;
}

}  // namespace armature

ARMATURE_PLUGIN(armature::SrsArmAngle);
