// SPDX-License-Identifier: Apache-2.0
// Both builds of the kernel answer the same.
#include "four_arms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "puma_goal.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

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
