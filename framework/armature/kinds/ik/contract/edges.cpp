// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/edges.hpp"

#include <fmt/format.h>

namespace armature::ik_contract {
namespace {

constexpr double kOnTheWay = 1e-6;   // [m], [rad]: still the same pose
constexpr double kPromised = 0.995;  // of a set at an edge

/// The straight way from `a` to `b` keeps the pose: a motion of the arm within itself, as at a
/// singular wrist. The two are one solution.
bool same_by_self_motion(const Probe& probe, const JointVector& a, const JointVector& b) {
  constexpr int kSteps = 8;
  JointVector way = b - a;
  for (int i = 0; i < way.size(); ++i) {
    if (turns_freely(probe.model(), i)) way[i] = wrap_angle(way[i]);
  }
  for (int i = 1; i < kSteps; ++i) {
    const PoseResidual off = probe.residual_of(a + (1.0 * i / kSteps) * way, probe.goal());
    if (!(off.position_m <= kOnTheWay) || !(off.angle_rad <= kOnTheWay)) return false;
  }
  return true;
}

bool is_found(const Probe& probe, const JointVector& q) {
  if (probe.nearest(q) <= kOnePosture) return true;
  for (const IkBranch& branch : probe.found()) {
    if (same_by_self_motion(probe, branch.q, q)) return true;
  }
  return false;
}

}  // namespace

void EdgeSet::ask(const IkGoal& goal, const JointVector& q) {
  ++questions_;
  ask_from_anywhere(goal);
  ask_from_itself(goal, q);
}

void EdgeSet::ask_from_anywhere(const IkGoal& goal) {
  const JointVector seed = probe_.random_joints();
  probe_.solve(goal, seed);
  expect_true_residuals(probe_);
  expect_true_flags(probe_);
  const bool ok = probe_.status().code == IkStatus::Code::ok;
  if (ok) ++reached_;
  if (!ok && !missed_) missed_ = {goal, seed};
  if (!ok && probe_.subject().closed_form) {
    probe_.violated(fmt::format("{}: {}", name_, describe(probe_.status())));
  }
}

void EdgeSet::ask_from_itself(const IkGoal& goal, const JointVector& q) {
  probe_.solve(goal, q);
  expect_true_residuals(probe_);
  expect_true_flags(probe_);
  if (probe_.status().code != IkStatus::Code::ok) {
    return probe_.violated(
        fmt::format("{}, the seed is a solution: {}", name_, describe(probe_.status())));
  }
  if (!probe_.subject().closed_form) return;
  if (probe_.redundant()) {
    const auto own = probe_.solver().redundancy_of(q);
    if (!own) return;
    ask_at(*own, goal, q);
  }
  if (is_found(probe_, q)) return;
  probe_.violated(
      fmt::format("{}: the seed is a solution, the nearest of {} branches is {:.3g} away", name_,
                  probe_.found().count, probe_.nearest(q)));
}

/// What a redundant arm chooses for itself need not be near `q`; asked for the redundancy of `q` it
/// has no choice.
void EdgeSet::ask_at(double redundancy, IkGoal goal, const JointVector& q) {
  goal.redundancy = redundancy;
  probe_.solve(goal, q);
  expect_true_residuals(probe_);
  expect_true_flags(probe_);
}

void EdgeSet::close() {
  if (questions_ == 0) return;
  const double part = 1.0 * reached_ / questions_;
  if (reached_ < questions_) {
    std::string& note = probe_.report().note;
    note += fmt::format("{}{} {:.1f} %", note.empty() ? "reached: " : ", ", name_, 100 * part);
  }
  if (probe_.subject().any_seed_at_edges && part < kPromised) {
    probe_.violated_by(
        missed_->first, missed_->second,
        fmt::format("{}: {} of {} reached from random seeds, `any_seed_at_edges` promises {} %",
                    name_, reached_, questions_, 100 * kPromised));
  }
}

}  // namespace armature::ik_contract
