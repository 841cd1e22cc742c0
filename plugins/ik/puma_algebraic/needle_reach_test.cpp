// SPDX-License-Identifier: Apache-2.0
// The reach of a needle's line told in closed form, against arms worked out at many depths.
#include "needle_reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace armature {
namespace {

class NeedleReach : public testing::Test {
 protected:
  double any(double lower, double upper) {
    return std::uniform_real_distribution{lower, upper}(random_);
  }
  /// With and without a1 and d2, forearm and upper arm alike or not.
  ArmNumbers random_arm() {
    ArmNumbers arm{};
    arm.a2 = any(0.2, 0.6);
    arm.forearm = any(0, 1) < 0.5 ? any(0.2, 0.6) : arm.a2;
    arm.a1 = any(0, 1) < 0.5 ? any(-0.3, 0.3) : 0;
    arm.d2 = any(0, 1) < 0.7 ? any(-0.3, 0.3) : 0;
    arm.cos_beta = 1;
    std::fill(arm.half, arm.half + 6, 10);
    std::fill(arm.sign, arm.sign + 6, 1);
    arm.needle = true;
    return arm;
  }
  Eigen::Vector3d random_direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d{normal(random_), normal(random_), normal(random_)}.normalized();
  }
  /// A line through a place anywhere up to 1.5 m away, which leads into any direction.
  PumaGoal random_goal() {
    PumaGoal goal;
    const Eigen::Vector3d place = any(0, 1.5) * random_direction(), way = random_direction();
    goal.at_zero.task = ArmQuestion::Task::pointing;
    goal.at_zero.wrist = {place.x(), place.y(), place.z()};
    goal.at_zero.a = goal.needle = {way.x(), way.y(), way.z()};
    goal.at_zero.slack = 1e-11;
    return goal;
  }

  std::mt19937_64 random_{20261122};
};

TEST_F(NeedleReach, OfOnePlaceIsThatOfTheArms) {
  SCOPED_TRACE("seed 20261122");
  std::array<int, 2> seen{};
  for (int i = 0; i < 20000; ++i) {
    const ArmNumbers arm = random_arm();
    const PumaGoal goal = random_goal();
    FourArms arms;
    arm_kernel().solve(arm, goal.at_zero, arms);
    const bool reached = std::ranges::any_of(arms.reached, [](bool one) { return one; });
    const ReachMiss miss = miss_at(arm, goal.at_zero.wrist);
    ++seen[reached ? 1 : 0];
    ASSERT_EQ(miss.shortfall <= goal.at_zero.slack, reached) << i;
    if (reached) continue;
    EXPECT_NEAR(miss.shortfall, arms.shortfall, 1e-14);
    EXPECT_EQ(miss.detail, arms.detail);
  }
  EXPECT_GT(std::ranges::min(seen), 2000);
}

TEST_F(NeedleReach, OfALineIsOutOfReachOnlyWhereEveryDepthIs) {
  SCOPED_TRACE("seed 20261122");
  constexpr int kDepths = 1000;
  int surely = 0, unsure = 0;
  for (int i = 0; i < 5000; ++i) {
    const ArmNumbers arm = random_arm();
    const PumaGoal goal = random_goal();
    const NeedleTask task{arm_kernel(), arm, goal, any(-0.3, 0), any(0, 0.3)};
    ReachMiss least{10, ""};
    for (int k = 0; k <= kDepths; ++k) {
      const double depth = std::lerp(task.least, task.most, 1.0 * k / kDepths);
      const ReachMiss there = miss_at(arm, goal.at(depth).wrist);
      if (there.shortfall < least.shortfall) least = there;
    }
    const auto told = line_out_of_reach(task);
    if (!told) {
      unsure += least.shortfall > 0 ? 1 : 0;
      continue;
    }
    ++surely;
    ASSERT_GT(least.shortfall, 0) << i;
    // Of two depths that are nearly as good it may be the other one.
    EXPECT_LE(told->shortfall, 1.01 * least.shortfall + 1e-12) << i;
    EXPECT_GE(told->shortfall, 0.9 * least.shortfall - 1e-3) << i;
  }
  EXPECT_GT(surely, 1000);
  EXPECT_LT(unsure, surely / 10) << "most lines out of reach are known to be without a search";
}

}  // namespace
}  // namespace armature
