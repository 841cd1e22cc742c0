// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "puma_goal.hpp"

namespace armature {

/// A goal for an arm with a needle, and the depths [m], rising, between which both searches over
/// the depth look for what they want: equal steps, the rims of reach, ever smaller steps towards
/// these and the ends of the range, and in between where a wrist comes nearest to reach. Bounded,
/// no allocation.
class NeedleLine {
 public:
  static constexpr int kSteps = 256;  // equal ones

  NeedleLine(const ArmKernel& kernel, const PumaArm& arm, const PumaGoal& goal, double least,
             double most);

  const ArmKernel& kernel() const { return kernel_; }
  const PumaArm& arm() const { return arm_; }
  ArmQuestion at(double depth) const { return goal_.at(depth); }
  double step(int i) const { return i == kSteps ? most_ : least_ + (most_ - least_) * i / kSteps; }
  /// All, steps and others.
  const double* begin() const { return depth_.data(); }
  const double* end() const { return depth_.data() + count_; }
  /// Where the wrist misses reach least, or is farthest within.
  double nearest_to_reach() const { return best_; }
  /// By how much it misses there; none when some depth is reached.
  std::optional<Miss> miss() const;

 private:
  /// Of a shoulder at every step [m], between infinities.
  using Misses = std::array<double, kSteps + 3>;

  double miss_at(double depth, double side);
  void add(double depth);
  /// Ever smaller steps from `inside` to `rim`.
  void approach(double inside, double rim);
  void add_rim(double inside, double outside, double side);
  void look_around(int i, const Misses& miss, double side);

  const ArmKernel& kernel_;
  const PumaArm& arm_;
  const PumaGoal& goal_;
  double least_, most_, slack_;
  double best_ = 0, least_miss_ = std::numeric_limits<double>::infinity();  // [m]
  std::array<double, 512> depth_;
  int count_ = 0;
};

/// Of the steps of `line`, the one nearest to `wanted` where a branch keeps the limits; if there is
/// none, a depth in between where one does; else the step nearest to `wanted` where a branch
/// reaches. Some depth has to be reached.
double choose_depth(const NeedleLine& line, double wanted);

}  // namespace armature
