// SPDX-License-Identifier: Apache-2.0
// SR-1, insertion along a line with the needle as sixth joint.
#include <gtest/gtest.h>

#include "armature/kinds/ik/test_goals.hpp"
#include "sr1_arms.hpp"

namespace armature::paper {
namespace {

/// The insertion of the reference plan.
struct Insertion {
  Eigen::Vector3d entry = sr1()["minmax"]["entry"].numbers();
  Eigen::Vector3d target = sr1()["minmax"]["target"].numbers();
  Eigen::Vector3d along = (target - entry).normalized();
  double depth = (target - entry).norm();
};

TEST(Sr1Needle, TheFileIsTheArmOfSr1WithTheReferencesRange) {
  const SolvedArm needle = sr1_needle(), arm = sr1_with_tool(0);
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint &a = needle.model->joints()[i], &b = arm.model->joints()[i];
    EXPECT_EQ(a.a, b.a);
    EXPECT_EQ(a.alpha, b.alpha);
    EXPECT_EQ(a.d, b.d);
    if (i == 5) continue;
    EXPECT_EQ(a.lower, b.lower);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.max_velocity, b.max_velocity);
    EXPECT_EQ(a.max_acceleration, b.max_acceleration);
  }
  const Joint& slide = needle.model->joints()[5];
  EXPECT_EQ(slide.type, Joint::Type::prismatic);
  EXPECT_EQ(slide.lower, sr1()["model"]["d6_range"][0].number());
  EXPECT_EQ(slide.upper, sr1()["model"]["d6_range"][1].number());
}

TEST(Sr1Needle, AnInsertionMovesTheNeedleAndNothingElse) {
  const Insertion plan;
  EXPECT_NEAR(plan.depth, 0.0735, 5e-5);
  const SolvedArm arm = sr1_needle();
  const double deepest = arm.model->upper()[5];
  IkGoal goal;
  goal.pose = {plan.target, Direction{plan.along}};
  goal.redundancy = deepest;
  IkBranches at_target, here;
  ASSERT_NE(arm.solve(goal, *arm.model->home(), at_target).code, IkStatus::Code::out_of_reach);
  ASSERT_EQ(at_target.count, 8);
  for (int step = 0; step <= 10; ++step) {
    const double back = plan.depth * step / 10;
    goal.pose.position = plan.target - back * plan.along;
    goal.redundancy = deepest - back;
    arm.solve(goal, *arm.model->home(), here);
    ASSERT_EQ(here.count, 8);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(here.branch[i].label, at_target.branch[i].label);
      EXPECT_LE(test::joint_distance(here.branch[i].q.head<5>(), at_target.branch[i].q.head<5>()),
                1e-14);
      EXPECT_EQ(here.branch[i].q[5], deepest - back);
    }
  }
}

}  // namespace
}  // namespace armature::paper
