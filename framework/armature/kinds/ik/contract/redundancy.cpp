// SPDX-License-Identifier: Apache-2.0
// The laws of what a pose leaves free: the arm angle, or the depth of a needle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "armature/kinds/ik/contract/laws.hpp"

namespace armature::ik_contract {

void redundancy_is_kept(Probe& probe) {
  if (!probe.redundant()) {
    probe.report().skipped = "the arm is not redundant";
    return;
  }
  if (!probe.subject().closed_form) {
    probe.report().skipped = "`all_branches` is not provided";
    return;
  }
  std::uniform_real_distribution<double> angle{-std::numbers::pi, std::numbers::pi};
  int answered = 0;
  for (int i = 0; i < probe.subject().poses; ++i) {
    IkGoal goal = probe.goal_at(probe.random_joints());
    goal.redundancy =
        probe.solver().redundancy_of(probe.random_joints()).value_or(angle(probe.random()));
    probe.solve(goal, probe.random_joints());
    if (probe.found().count > 0) ++answered;
    for (const IkBranch& branch : probe.found()) {
      if (std::abs(wrap_angle(branch.redundancy - *goal.redundancy)) <= 1e-9) continue;
      probe.violated(fmt::format("branch {} has arm angle {}, asked was {}", branch.label,
                                 branch.redundancy, *goal.redundancy));
    }
    expect_true_residuals(probe);
  }
  probe.report().note = fmt::format("{} had branches", answered);
}

namespace {

constexpr double kBeyond = 1e-6;    // [rad] or [m] beyond an end the limits are surely left
constexpr double kRounding = 1e-9;  // [rad] or [m] by which a told end may be off

/// What a solver tells about the redundancy of one goal, put to the test by asking it there.
class ToldIntervals {
 public:
  ToldIntervals(Probe& probe, const IkGoal& goal, const JointVector& seed)
      : probe_{probe},
        goal_{goal},
        seed_{seed},
        is_angle_{!probe.solver().redundancy_is_length()},
        answered_{probe.feasible_redundancy(goal, seed, intervals_)} {}

  bool answered() const { return answered_; }

  /// Finite, the right way round, within a turn, rising and apart within a branch.
  void expect_order() {
    if (intervals_.count < 0 || intervals_.count > RedundancyIntervals::kCapacity) {
      return probe_.violated(fmt::format("{} intervals were counted", intervals_.count));
    }
    for (const RedundancyInterval& interval : intervals_) {
      const auto& [label, lower, upper] = interval;
      const bool within_a_turn = lower >= -std::numbers::pi && upper <= std::numbers::pi;
      if (!std::isfinite(lower) || !(lower <= upper) || (is_angle_ && !within_a_turn)) {
        probe_.violated(fmt::format("{} is no interval", described(interval)));
      }
      const auto earlier = std::find_if(intervals_.begin(), &interval, [&](const auto& other) {
        return other.label == label && !(other.upper < lower);
      });
      if (earlier != &interval) {
        probe_.violated(fmt::format("{} is told behind {}: they must rise and be apart",
                                    described(interval), described(*earlier)));
      }
    }
  }

  /// At its ends and inside, a branch keeps the limits; beyond its ends it does not.
  void expect_truth() {
    for (const RedundancyInterval& interval : intervals_) {
      for (const double part : {0.0, 0.001, 0.3, 0.5, 0.8, 0.999, 1.0}) {
        const double at = std::lerp(interval.lower, interval.upper, part);
        if (keeps_limits_at(at, interval.label)) continue;
        probe_.violated(fmt::format("{} is told to keep the limits, at {:.17g} it does not",
                                    described(interval), at));
      }
      expect_end(interval, interval.lower, interval.lower - kBeyond);
      expect_end(interval, interval.upper, interval.upper + kBeyond);
    }
  }

  /// The joints that made the goal keep the limits, so their redundancy is told.
  void expect_generator(const JointVector& q) {
    const auto own = probe_.solver().redundancy_of(q);
    if (!own) return probe_.violated("intervals are told, and no redundancy of joints");
    solve_at(*own);
    const auto branch =
        std::find_if(probe_.found().begin(), probe_.found().end(),
                     [&](const IkBranch& one) { return probe_.distance(one.q, q) <= kOnePosture; });
    if (branch == probe_.found().end()) {
      return probe_.violated(fmt::format(
          "at the redundancy {:.17g} of the joints that made the goal, the nearest of {} branches "
          "is {:.3g} away",
          *own, probe_.found().count, probe_.nearest(q)));
    }
    const bool told = std::any_of(probe_.found().begin(), probe_.found().end(), [&](auto& one) {
      return probe_.distance(one.q, q) <= kOnePosture && is_inside(one.label, *own, kRounding);
    });
    if (told) return;
    probe_.violated(
        fmt::format("joints within limits made this goal at {:.17g}, which no interval "
                    "of {} holds",
                    *own, branch->label));
  }

 private:
  std::string described(const RedundancyInterval& interval) const {
    return fmt::format("{} [{:.9g}, {:.9g}] {}", interval.label, interval.lower, interval.upper,
                       is_angle_ ? "rad" : "m");
  }

  void solve_at(double redundancy) {
    IkGoal there = goal_;
    there.redundancy = is_angle_ ? wrap_angle(redundancy) : redundancy;
    probe_.solve(there, seed_);
  }
  bool keeps_limits_at(double redundancy, std::string_view label) {
    solve_at(redundancy);
    return std::any_of(probe_.found().begin(), probe_.found().end(), [&](const IkBranch& branch) {
      return branch.within_limits && branch.label == label;
    });
  }
  bool is_inside(std::string_view label, double redundancy, double by) const {
    return std::any_of(intervals_.begin(), intervals_.end(), [&](const auto& interval) {
      const double middle = 0.5 * (interval.lower + interval.upper);
      const double off = is_angle_ ? wrap_angle(redundancy - middle) : redundancy - middle;
      return interval.label == label &&
             std::abs(off) <= 0.5 * (interval.upper - interval.lower) + by;
    });
  }

  /// Where the circle is cut nothing ends; and another interval may begin next to this one.
  void expect_end(const RedundancyInterval& interval, double end, double beyond) {
    if (is_angle_ && std::abs(end) == std::numbers::pi) return;
    if (is_inside(interval.label, beyond, 0)) return;
    if (!keeps_limits_at(beyond, interval.label)) return;
    probe_.violated(
        fmt::format("{} is told to end at {:.17g}, and {:.0e} beyond it still keeps "
                    "the limits",
                    described(interval), end, kBeyond));
  }

  Probe& probe_;
  IkGoal goal_;
  JointVector seed_;
  bool is_angle_;
  RedundancyIntervals intervals_;
  bool answered_;
};

/// Of a goal that cannot be reached, or is none, nothing is told.
void expect_nothing_told(Probe& probe, const char* what, const IkGoal& goal,
                         const JointVector& seed) {
  RedundancyIntervals intervals;
  if (!probe.feasible_redundancy(goal, seed, intervals) && intervals.count == 0) return;
  probe.violated_without_line(
      fmt::format("the intervals of {} are told, {} of them", what, intervals.count));
}

void expect_nothing_told_of_bad_goals(Probe& probe) {
  const JointVector q = probe.random_joints();
  IkGoal goal = probe.goal_at(q);
  goal.pose.position.x() += 1e6;
  expect_nothing_told(probe, "a goal 1e6 m out of reach", goal, q);
  goal.pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  expect_nothing_told(probe, "a position that is no number", goal, q);
}

}  // namespace

void redundancy_is_feasible(Probe& probe) {
  if (!probe.redundant()) {
    probe.report().skipped = "the arm is not redundant";
    return;
  }
  RedundancyIntervals any;
  const JointVector resting = resting_position(probe.model());
  if (!probe.feasible_redundancy(probe.goal_at(resting), resting, any)) {
    probe.report().skipped = "the solver tells no intervals of the redundancy";
    return;
  }
  for (int i = 0; i < probe.subject().poses / 4; ++i) {
    const JointVector q = probe.random_joints();
    ToldIntervals intervals{probe, probe.goal_at(q), probe.random_joints()};
    if (!intervals.answered()) {
      probe.violated("joints within limits made this goal, and no intervals are told");
      continue;
    }
    intervals.expect_order();
    intervals.expect_truth();
    intervals.expect_generator(q);
  }
  expect_nothing_told_of_bad_goals(probe);
}

}  // namespace armature::ik_contract
