// SPDX-License-Identifier: Apache-2.0
// The kernel's arithmetic, and that both builds of it answer the same.
#include "four_arms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lanes.hpp"
#include "puma_goal.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

TEST(Lanes, TheArctangentIsThatOfTheStandardLibraryTo5em16) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> unit{-1, 1}, power{-20, 20};
  for (int i = 0; i < 100000; ++i) {
    const double y = unit(random) * (i % 2 == 0 ? 1 : std::pow(10, power(random)));
    const double x = unit(random);
    const Lanes angle = arctangent(Lanes{y, x, 0, y}, Lanes{x, y, x, 0});
    EXPECT_NEAR(angle[0], std::atan2(y, x), 5e-16);
    EXPECT_NEAR(angle[1], std::atan2(x, y), 5e-16);
    EXPECT_NEAR(angle[2], std::atan2(0, x), 5e-16);
    EXPECT_NEAR(angle[3], std::atan2(y, 0), 5e-16);
  }
  EXPECT_EQ(arctangent(all(0), all(0))[0], 0);
}

TEST(Lanes, AnglesAreWrappedToWhereTheKindWantsThem) {
  const Lanes angle = wrapped(Lanes{kPi, -kPi, std::nextafter(-kPi, -4), 7});
  EXPECT_EQ(angle[0], -kPi);
  EXPECT_EQ(angle[1], -kPi);
  EXPECT_LT(angle[2], kPi);
  EXPECT_GT(angle[2], 3.1415926);
  EXPECT_NEAR(angle[3], 7 - 2 * kPi, 1e-15);
}

TEST(FourArms, BothBuildsOfTheKernelAnswerTheSame) {
  if (&arm_kernel() == &portable_arm_kernel()) GTEST_SKIP() << "this processor has one only";
  std::mt19937_64 random{2};
  const PumaArm arm = puma_arm(*sr1()).value();
  const ArmNumbers numbers = numbers_of(arm, *sr1());
  for (int i = 0; i < 10000; ++i) {
    IkGoal goal = rotation_goal(*sr1(), random_joints(*sr1(), random));
    if (i % 4 == 0) goal.pose.position *= 2;
    const PumaGoal own = puma_goal(arm, numbers, goal, random_joints(*sr1(), random));
    FourArms a, b;
    portable_arm_kernel().solve(numbers, own.at_zero, a);
    avx2_arm_kernel().solve(numbers, own.at_zero, b);
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(a.reached[k], b.reached[k]);
      if (!a.reached[k]) {
        EXPECT_NEAR(a.shortfall, b.shortfall, 1e-14);
        continue;
      }
      for (int j = 0; j < 6; ++j) {
        EXPECT_NEAR(wrap_angle(a.joint[0][j][k] - b.joint[0][j][k]), 0, 1e-9);
        EXPECT_NEAR(wrap_angle(a.joint[1][j][k] - b.joint[1][j][k]), 0, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace armature
