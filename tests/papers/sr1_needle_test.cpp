// SPDX-License-Identifier: Apache-2.0
// SR-1, insertion along a line: with the needle as sixth joint, and with six revolute joints.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "sr1_arms.hpp"

namespace armature::paper {
namespace {

/// The insertion of the reference plan.
struct Insertion {
  Eigen::Vector3d entry = sr1()["minmax"]["entry"].numbers();
  Eigen::Vector3d target = sr1()["minmax"]["target"].numbers();
  Eigen::Vector3d along = (target - entry).normalized();
  double depth = (target - entry).norm();
  Eigen::Matrix3d R;

  Insertion() {
    for (std::size_t i = 0; i < 3; ++i) {
      R.row(static_cast<Eigen::Index>(i)) = sr1()["minmax"]["R"][i].numbers();
    }
  }
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
      EXPECT_LE(wrapped_difference(here.branch[i].q.head<5>(), at_target.branch[i].q.head<5>()),
                1e-14);
      EXPECT_EQ(here.branch[i].q[5], deepest - back);
    }
  }
}

TEST(Sr1Needle, SixRevoluteJointsInterpolatedFromEntryToTargetLeaveTheLine) {
  const Insertion plan;
  const SolvedArm arm = sr1_with_tool(sr1()["minmax"]["tool_d6"].number());
  const auto branches_at = [&](const Eigen::Vector3d& position) {
    IkGoal goal;
    goal.pose = {position, Eigen::Quaterniond{plan.R}};
    IkBranches found;
    arm.solve(goal, JointVector::Zero(6), found);
    return found;
  };
  const IkBranches entry = branches_at(plan.entry), target = branches_at(plan.target);
  ASSERT_EQ(entry.count, 8);
  double largest_turn = 0, min_off = 1, max_off = 0, min_tilt = 9, max_tilt = 0;
  for (std::size_t i = 0; i < 8; i += 2) {
    JointVector turn = target.branch[i].q - entry.branch[i].q;
    for (double& angle : turn) angle = wrap_angle(angle);
    largest_turn = std::max(largest_turn, turn.cwiseAbs().maxCoeff());
    double off = 0, tilt = 0;
    for (int step = 0; step <= 100; ++step) {
      const JointVector q = entry.branch[i].q + 0.01 * step * turn;
      const Eigen::Isometry3d pose = forward_kinematics(*arm.model, q);
      const Eigen::Vector3d from_entry = pose.translation() - plan.entry;
      off = std::max(off, from_entry.cross(plan.along).norm());
      tilt = std::max(tilt, pose.linear().col(2).cross(plan.along).norm());
    }
    min_off = std::min(min_off, off), max_off = std::max(max_off, off);
    min_tilt = std::min(min_tilt, tilt), max_tilt = std::max(max_tilt, tilt);
  }
  EXPECT_NEAR(largest_turn / kDegree, 19, 0.5);
  EXPECT_NEAR(1e3 * min_off, 1.6, 0.05);
  EXPECT_NEAR(1e3 * max_off, 2.3, 0.05);
  EXPECT_NEAR(min_tilt / kDegree, 0.2, 0.05);
  EXPECT_NEAR(max_tilt / kDegree, 0.45, 0.05);
}

}  // namespace
}  // namespace armature::paper
