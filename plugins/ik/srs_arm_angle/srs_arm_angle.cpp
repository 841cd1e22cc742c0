// SPDX-License-Identifier: Apache-2.0
#include "srs_arm_angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "arm_angle_choice.hpp"
#include "arm_branches.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "feasible_angles.hpp"
#include "ik_srs_arm_angle_parameters.hpp"
#include "srs_goal.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

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

void copy_branch(const EightBranches& from, std::size_t k, std::size_t to, EightBranches& out) {
  const auto copy_bit = [&](unsigned mask, unsigned& into) {
    into = (into & ~(1U << to)) | (mask >> k & 1) << to;
  };
  for (std::size_t i = 0; i < 7; ++i) out.joint[i][to] = from.joint[i][k];
  out.position_m[to] = from.position_m[k];
  out.angle_rad[to] = from.angle_rad[k];
  copy_bit(from.within_limits, out.within_limits);
  copy_bit(from.singular, out.singular);
}

/// At the end of a span rounding may put a fast joint of branch `i` beyond its limit: it is solved
/// a little further inside.
void move_inside(const SrsArm& arm, const SrsGoal& goal, const Spans& spans, std::size_t i,
                 EightPlaces& at, EightBranches& found) {
  constexpr double kParts[4]{1e-9, 1e-6, 1e-3, 1.0};
  const double half_turn = (kOfElbow1 >> i & 1) != 0 ? kPi : 0;
  for (const Span& span : (half_turn == 0 ? spans : half_turned(spans))) {
    if (at.arm_angle[i] < span.lower || at.arm_angle[i] > span.upper) continue;
    const double inwards = 0.5 * (span.lower + span.upper) - at.arm_angle[i];
    EightPlaces tried;
    for (std::size_t k = 0; k < 8; ++k) {
      tried.branch[k] = static_cast<int>(i);
      tried.arm_angle[k] = at.arm_angle[i] + kParts[k % 4] * inwards;
    }
    EightBranches inside;
    solve_each(arm, goal, tried, inside);
    for (std::size_t k = 0; k < 4; ++k) {
      if ((inside.within_limits >> k & 1) == 0) continue;
      at.arm_angle[i] = tried.arm_angle[k];
      return copy_branch(inside, k, i, found);
    }
  }
}

IkStatus status_of(const EightBranches& found) {
  if (found.within_limits != 0) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

void set_branches(const EightPlaces& at, const EightBranches& found, IkBranches& out) {
  for (std::size_t i = 0; i < 8; ++i) {
    IkBranch& branch = out.add();
    branch.label = kLabels[i];
    branch.q.resize(7);
    for (std::size_t k = 0; k < 7; ++k) branch.q.data()[k] = found.joint[k][i];
    branch.redundancy = at.arm_angle[i];
    branch.residual = {found.position_m[i], found.angle_rad[i]};
    branch.within_limits = (found.within_limits >> i & 1) != 0;
    branch.singular = (found.singular >> i & 1) != 0;
  }
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> SrsArmAngle::make(const RobotModel& model,
                                                      const Params& params) {
  const auto arm = srs_arm(model);
  if (!arm) return tl::unexpected{arm.error()};
  return std::unique_ptr<IkSolver>{
      new SrsArmAngle{model, *arm, objective_of(Parameters::read(params))}};
}

std::optional<double> SrsArmAngle::redundancy_of(const JointVector& q) const {
  return arm_angle_of(arm_, q);
}

void SrsArmAngle::solve_best(const SrsGoal& goal, const JointVector& seed,
                             std::optional<double> last, EightPlaces& at,
                             EightBranches& found) const {
  SpansByBranch spans;
  set_feasible_angles(arm_, goal, spans);
  const Aim aim{objective_, last.has_value(), last.value_or(0)};
  std::array<double, 8> best;
  ArmAngleChoice{arm_, goal, aim, seed}.choose(spans, best);
  for (std::size_t i = 0; i < 8; ++i) {
    at.branch[i] = static_cast<int>(i);
    at.arm_angle[i] = best[i];
  }
  solve_each(arm_, goal, at, found);
  for (std::size_t i = 0; i < 8; ++i) {
    if ((found.within_limits >> i & 1) != 0 || spans[i].count == 0) continue;
    move_inside(arm_, goal, spans[i], i, at, found);
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
  EightPlaces at;
  EightBranches found;
  if (goal.redundancy) {
    std::fill_n(at.arm_angle, 8, wrap_angle(*goal.redundancy));
    srs_arm_angle::solve(arm_, own, at.arm_angle[0], found);
  } else {
    std::optional<double> last = state.last_redundancy;
    if (last) last = wrap_angle(*last);
    solve_best(own, seed, last, at, found);
  }
  set_branches(at, found, out);
  return status_of(found);
}

bool SrsArmAngle::feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                                      RedundancyIntervals& out) const {
  out.clear();
  if (invalid_input(*model_, goal, seed)) return false;
  const SrsGoal own = srs_goal(arm_, goal, seed);
  if (own.shortfall > 0) return false;
  SpansByBranch spans;
  set_feasible_angles(arm_, own, spans);
  for (std::size_t i = 0; i < 8; ++i) {
    if ((kOfElbow1 >> i & 1) != 0) spans[i] = half_turned(spans[i]);
    for (const Span& span : spans[i]) out.add({kLabels[i], span.lower, span.upper});
  }
  return true;
}

}  // namespace armature::ik::srs_arm_angle

ARMATURE_PLUGIN(armature::ik::srs_arm_angle::SrsArmAngle);
