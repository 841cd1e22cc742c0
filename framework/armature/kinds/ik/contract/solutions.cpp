// SPDX-License-Identifier: Apache-2.0
// The laws of what is found for random goals.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/search.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/singular_values.hpp"
#include "armature/robot/kinematics/task_error.hpp"

namespace armature::ik_contract {
namespace {

/// How near the branches come to `q` when the arm angle is free to choose: a grid, then a golden
/// section around its best places.
double nearest_at_any_arm_angle(Probe& probe, IkGoal goal, const JointVector& q) {
  constexpr int kGrid = 64, kPlaces = 3;
  constexpr double kStep = 2 * std::numbers::pi / kGrid;
  const auto at = [&](double arm_angle) {
    goal.redundancy = wrap_angle(arm_angle);
    probe.solve(goal, q);
    return probe.nearest(q);
  };
  std::array<std::pair<double, double>, kGrid> grid;  // distance, arm angle
  for (int i = 0; i < kGrid; ++i) {
    const double arm_angle = -std::numbers::pi + i * kStep;
    grid[static_cast<std::size_t>(i)] = {at(arm_angle), arm_angle};
  }
  std::ranges::partial_sort(grid, grid.begin() + kPlaces);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPlaces && least > kOnePosture; ++i) {
    const double centre = grid[static_cast<std::size_t>(i)].second;
    least = std::min(least, at(golden_section(centre - kStep, centre + kStep, at)));
  }
  return least;
}

}  // namespace

void solutions_reach(Probe& probe) {
  for (int i = 0; i < probe.subject().poses; ++i) {
    const IkGoal goal = probe.goal_at(probe.random_joints());
    probe.solve(goal, probe.random_joints());
    expect_true_residuals(probe);
  }
}

void goals_are_reached(Probe& probe) {
  const bool promised = probe.subject().any_seed || probe.subject().closed_form;
  int reached = 0;
  for (int i = 0; i < probe.subject().poses; ++i) {
    const JointVector q = probe.random_joints();
    const IkGoal goal = probe.goal_at(q);
    probe.solve(goal, probe.random_joints());
    const bool ok = probe.status().code == IkStatus::Code::ok;
    if (ok) ++reached;
    if (!ok && promised) {
      probe.violated("a goal that joints within limits reach: " + describe(probe.status()));
    }
    if (promised) continue;
    probe.solve(goal, q);
    if (probe.status().code != IkStatus::Code::ok) {
      probe.violated("a goal that the seed itself reaches: " + describe(probe.status()));
    }
  }
  if (!promised) {
    probe.report().note = fmt::format(
        "only seeds that are solutions: `any_seed` is not provided; from random ones {:.1f} %",
        100.0 * reached / probe.subject().poses);
  }
}

void generator_is_found(Probe& probe) {
  const bool all = probe.subject().closed_form;
  for (int i = 0; i < probe.subject().poses; ++i) {
    const JointVector q = probe.random_joints();
    IkGoal goal = probe.goal_at(q);
    if (all && probe.redundant()) goal.redundancy = probe.solver().redundancy_of(q);
    probe.solve(goal, all ? probe.random_joints() : q);
    double distance = probe.nearest(q);
    if (all && probe.redundant() && !goal.redundancy && distance > kOnePosture) {
      distance = nearest_at_any_arm_angle(probe, goal, q);
    }
    if (!(distance <= kOnePosture)) {
      const JointVector joints = probe.model().to_all(q);
      probe.violated(
          fmt::format("the joints [{:.9g}] made this goal, the nearest of {} branches is "
                      "{:.3g} away",
                      fmt::join(joints, ", "), probe.found().count, distance));
    }
  }
  if (!all) probe.report().note = "only from the joints themselves: `all_branches` is not provided";
}

void flags_are_true(Probe& probe) {
  for (int i = 0; i < probe.subject().poses; ++i) {
    const IkGoal goal = probe.goal_at(probe.random_joints());
    probe.solve(goal, probe.random_joints());
    expect_true_flags(probe);
  }
}

namespace {

/// The rows of the task, and the redundancy that the solver keeps.
SmallMatrix rows_that_are_kept(const Probe& probe, const JointVector& q) {
  SmallMatrix rows = task_jacobian(probe.model(), q);
  const auto redundancy = probe.solver().redundancy_of(q);
  if (!probe.redundant() || !redundancy) return rows;
  constexpr double kStep = 1e-6;
  rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
  for (int i = 0; i < probe.model().dof(); ++i) {
    JointVector moved = q;
    moved[i] += kStep;
    const double there = probe.solver().redundancy_of(moved).value_or(*redundancy);
    rows(rows.rows() - 1, i) = wrap_angle(there - *redundancy) / kStep;
  }
  return rows;
}

/// Far enough from singular for joints to follow the goal.
bool regular(const Probe& probe, const JointVector& q) {
  const bool wide = probe.model().dof() >= task_rows(probe.model());
  if (wide && manipulability(probe.model(), q) <= 0.02) return false;
  const SmallMatrix rows = rows_that_are_kept(probe, q);
  return smallest_singular_value(rows) > 0.05;
}

/// Branches before and after a small step of the goal: each has its like under the same label.
void expect_branches_follow(Probe& probe, const IkBranches& before, double allowed) {
  for (const IkBranch& branch : before) {
    if (!regular(probe, branch.q)) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const IkBranch& after : probe.found()) {
      if (after.label == branch.label) least = std::min(least, probe.distance(after.q, branch.q));
    }
    if (!(least <= allowed)) {
      probe.violated(
          fmt::format("the goal has moved a little, branch {} by {:.3g}", branch.label, least));
    }
  }
}

}  // namespace

void continuity(Probe& probe) {
  constexpr double kStep = 1e-6, kGain = 100;
  std::normal_distribution<double> normal;
  int checked = 0;
  for (int i = 0; i < probe.subject().poses / 4; ++i) {
    const JointVector q = probe.random_joints();
    if (!regular(probe, q)) continue;
    ++checked;
    JointVector step(probe.model().dof());
    for (double& value : step) value = normal(probe.random());
    const JointVector moved = q + kStep * step.normalized();
    IkGoal goal = probe.goal_at(q), next = probe.goal_at(moved);
    const bool all = probe.subject().closed_form;
    probe.solve(goal, q);
    if (all && probe.redundant() && probe.found().count > 0) {
      goal.redundancy = next.redundancy = probe.found().begin()->redundancy;
      probe.solve(goal, q);
    }
    const IkBranches before = probe.found();
    probe.solve(next, q);
    if (all) {
      expect_branches_follow(probe, before, kGain * kStep);
    } else if (const double nearest = probe.nearest(q); !(nearest <= kGain * kStep)) {
      probe.violated(fmt::format("the goal moves by {:.0e}, the joints by {:.3g}", kStep, nearest));
    }
  }
  if (checked == 0) probe.report().skipped = "no posture is far from singular";
}

}  // namespace armature::ik_contract
