// SPDX-License-Identifier: Apache-2.0
#include "needle_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "line_search.hpp"

namespace armature {
namespace {

double square(double x) { return x * x; }

Triple wrist_at(const PumaGoal& goal, double depth) {
  const Triple &at_zero = goal.at_zero.wrist, &by = goal.needle;
  return {at_zero.x - depth * by.x, at_zero.y - depth * by.y, at_zero.z - depth * by.z};
}

double from_axis_squared(const Triple& wrist) { return square(wrist.x) + square(wrist.y); }
double from_shoulder_squared(const Triple& wrist) {
  return from_axis_squared(wrist) + square(wrist.z);
}

/// The depths between which a line is looked at [m], and the wrist there.
struct Part {
  double from, to;
  double from_axis_squared, from_shoulder_squared;  // the most: both are convex along a line
};
Part part_of(const PumaGoal& goal, double from, double to) {
  const Triple first = wrist_at(goal, from), last = wrist_at(goal, to);
  return {from, to, std::max(from_axis_squared(first), from_axis_squared(last)),
          std::max(from_shoulder_squared(first), from_shoulder_squared(last))};
}

/// A line of wrists against three bounds of what the arm reaches. The wrist is d2 beside the arm's
/// plane, and in it at most a1 nearer to or farther from the shoulder than from the axis of
/// joint 2.
class Line {
 public:
  explicit Line(const NeedleTask& task)
      : arm_{task.arm},
        goal_{task.goal},
        all_{part_of(goal_, task.least, task.most)},
        nearest_{std::clamp(nearest_to_shoulder(), task.least, task.most)},
        slack_{task.goal.at_zero.slack + 1e-12 * (farthest_ + a1_ + offset_)} {}

  /// The depth that brings the wrist nearest to the shoulder.
  double nearest() const { return nearest_; }

  /// The depths at which the wrist passes d2 beside the axis of joint 1, where the miss has
  /// corners; the depth nearest to that axis where it does not.
  std::array<double, 2> beside_axis() const {
    const Triple &w = goal_.at_zero.wrist, &u = goal_.needle;
    const double flat = from_axis_squared(u);
    if (flat == 0) return {all_.from, all_.to};
    const double middle = (w.x * u.x + w.y * u.y) / flat;
    const double left = square(offset_) - from_axis_squared(wrist_at(goal_, middle));
    const double half = std::sqrt(std::max(left / flat, 0.0));
    return {std::clamp(middle - half, all_.from, all_.to),
            std::clamp(middle + half, all_.from, all_.to)};
  }

  /// Where no depth brings the wrist within reach, a miss [m] that none undercuts; else none.
  std::optional<double> surely_missed_by() const {
    const double outer = std::sqrt(square(farthest_ + a1_ + slack_) + square(offset_));
    const double min_squared = from_shoulder_squared(wrist_at(goal_, nearest_));
    if (min_squared > square(outer)) {
      return std::sqrt(min_squared - square(offset_)) - a1_ - farthest_;
    }
    // Of the rest only what is within `outer` of the shoulder.
    const double middle = nearest_to_shoulder();
    const double to_middle = from_shoulder_squared(wrist_at(goal_, middle));
    const double half = std::sqrt(std::max(square(outer) - to_middle, 0.0));
    const Part within =
        part_of(goal_, std::max(all_.from, middle - half), std::min(all_.to, middle + half));
    const double beside = std::max(offset_ - slack_, 0.0);
    if (within.from_axis_squared < square(beside)) {
      return std::max(offset_ - std::sqrt(all_.from_axis_squared), 0.0);
    }
    const double inner = std::abs(arm_.a2 - arm_.forearm) - a1_ - slack_;
    const bool folded = inner > 0 && within.from_shoulder_squared < square(inner) + square(beside);
    return folded ? std::optional{0.0} : std::nullopt;
  }

 private:
  double nearest_to_shoulder() const {
    const Triple &w = goal_.at_zero.wrist, &u = goal_.needle;  // of length 1
    return w.x * u.x + w.y * u.y + w.z * u.z;
  }

  const ArmNumbers& arm_;
  const PumaGoal& goal_;
  const double a1_ = std::abs(arm_.a1), offset_ = std::abs(arm_.d2);
  const double farthest_ = arm_.a2 + arm_.forearm;
  Part all_;
  double nearest_, slack_;
};

}  // namespace

ReachMiss miss_at(const ArmNumbers& arm, const Triple& wrist) {
  const double radius = std::sqrt(from_axis_squared(wrist)), offset = std::abs(arm.d2);
  const double farthest = arm.a2 + arm.forearm, nearest = std::abs(arm.a2 - arm.forearm);
  const double gap = radius - offset;
  if (gap < 0) {
    const double rho = std::sqrt(square(arm.a1) + square(wrist.z));
    const double stretch = rho - farthest, fold = nearest - rho;
    const double plane = std::max({stretch, fold, 0.0});
    return {std::sqrt(square(gap) + square(plane)), -gap > plane ? "too near the axis of joint 1"
                                                    : stretch > fold ? "the arm is stretched"
                                                                     : "the arm is folded"};
  }
  // The shoulder that brings axis 2 nearer to the wrist, and the other one: (37).
  const double along = std::sqrt(gap * (radius + offset));
  const double rho = std::sqrt(square(along - std::abs(arm.a1)) + square(wrist.z));
  const double other = std::sqrt(square(along + std::abs(arm.a1)) + square(wrist.z));
  if (rho > farthest) return {rho - farthest, "the arm is stretched"};
  if (other < nearest) return {nearest - other, "the arm is folded"};
  if (rho >= nearest || other <= farthest) return {};
  if (nearest - rho < other - farthest) return {nearest - rho, "the arm is folded"};
  return {other - farthest, "the arm is stretched"};
}

std::optional<ReachMiss> line_out_of_reach(const NeedleTask& task) {
  const Line line{task};
  const auto bound = line.surely_missed_by();
  if (!bound) return std::nullopt;
  constexpr int kSteps = 16;
  const auto miss = [&](double depth) { return miss_at(task.arm, wrist_at(task.goal, depth)); };
  double best = line.nearest();
  ReachMiss least = miss(best);
  const auto consider = [&](double depth) {
    const ReachMiss there = miss(depth);
    if (there.shortfall < least.shortfall) best = depth, least = there;
  };
  consider(task.least);
  consider(task.most);
  if (least.shortfall <= *bound * (1 + 1e-12)) return least;
  const double step = (task.most - task.least) / kSteps;
  for (int i = 1; i < kSteps; ++i) consider(task.least + i * step);
  for (const double depth : line.beside_axis()) consider(depth);
  consider(golden_maximum(std::max(best - step, task.least), std::min(best + step, task.most), 0,
                          [&](double depth) { return -miss(depth).shortfall; }));
  return least;
}

}  // namespace armature
