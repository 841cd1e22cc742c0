// SPDX-License-Identifier: Apache-2.0
// What joint 6 leaves free: the depth of a needle, the roll of a guide.
#include <cmath>
#include <set>

#include "needle_line.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

class Needle : public PumaTest {
 protected:
  Needle() : PumaTest{sr1_needle()} {}
  static JointVector with_depth(JointVector q, double depth) {
    q[5] = depth;
    return q;
  }
  static IkGoal at_depth(IkGoal goal, double depth) {
    goal.redundancy = depth;
    return goal;
  }
  const JointVector home_ = *model().home();
};

TEST_F(Needle, AGivenDepthBeyondTheRangeIsSolvedAndLeavesTheLimits) {
  const JointVector q = with_depth(home_, 0.31);
  EXPECT_EQ(solve(at_depth(direction_goal(q), 0.31), home_).code, IkStatus::Code::joint_limit);
  EXPECT_LE(probe_->nearest(q), 1e-9);
  for (const IkBranch& branch : found_) EXPECT_FALSE(branch.within_limits);
}

TEST_F(Needle, WithoutADepthTheSeedsIsKept) {
  EXPECT_EQ(solve(direction_goal(home_), with_depth(home_, 0.07)).code, IkStatus::Code::ok);
  for (const IkBranch& branch : found_) EXPECT_EQ(branch.redundancy, 0.07);
  expect_right(1e-12);
}

TEST_F(Needle, WhereTheSeedsDepthDoesNotServeTheNearestThatDoesIsTaken) {
  JointVector q = with_depth(home_, 0.3);
  q[2] = 0.5 - std::atan2(0.4318, 0.0203);  // 27 mm from stretched
  q[4] = 0.1;
  const IkGoal goal = direction_goal(q);
  EXPECT_EQ(solve(goal, with_depth(q, 0)).code, IkStatus::Code::ok);
  expect_right(1e-12);
  const double depth = found_.branch[0].redundancy;
  EXPECT_GT(depth, 0.1);
  EXPECT_LT(depth, 0.3);
  // One step nearer to the seed's: out of reach or limits.
  EXPECT_NE(solve(at_depth(goal, depth - 0.3 / 256), q).code, IkStatus::Code::ok);
}

TEST_F(Needle, AnInsertionMovesTheNeedleAlone) {
  for (int i = 0; i < 200; ++i) {
    IkGoal goal = direction_goal(with_depth(random_joints(), 0));
    solve(at_depth(goal, 0), home_);
    const IkBranches entry = found_;
    EXPECT_EQ(entry.count, 8);
    expect_right(1e-12);
    goal.pose.position += 0.08 * std::get<Direction>(goal.pose.orientation).unit;
    solve(at_depth(goal, 0.08), home_);
    ASSERT_EQ(found_.count, entry.count);
    for (int k = 0; k < entry.count; ++k) {
      const JointVector &now = found_.begin()[k].q, &then = entry.begin()[k].q;
      for (int j = 0; j < 5; ++j) EXPECT_NEAR(wrap_angle(now[j] - then[j]), 0, 1e-9);
      EXPECT_EQ(now[5], 0.08);
    }
  }
}

TEST_F(Needle, ARotationIsReachedInUpToFourDepthsAndAtTheEndsOfTheRange) {
  int most = 0;
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints();
    if (i % 2 == 0) q[5] = i % 4 == 0 ? model().lower()[5] : model().upper()[5];
    if (i % 3 == 0) q[4] = 0;
    EXPECT_EQ(solve(rotation_goal(q), random_joints()).code, IkStatus::Code::ok) << q.transpose();
    EXPECT_LE(probe_->nearest(q), 1e-6) << q.transpose();
    expect_right(1e-12);
    most = std::max(most, found_.count);
    std::set<std::string_view> labels;
    for (const IkBranch& branch : found_) labels.insert(branch.label);
    EXPECT_EQ(labels.size(), static_cast<std::size_t>(found_.count));
  }
  EXPECT_GT(most, 2);
}

TEST_F(Needle, ARollThatNoDepthMakesRightIsNotReachedAndSaysBySoMuch) {
  JointVector q = home_;
  q[4] = 0.2;
  IkGoal goal = rotation_goal(q);
  goal.pose.orientation = std::get<Eigen::Quaterniond>(goal.pose.orientation) *
                          Eigen::AngleAxisd{1.5, Eigen::Vector3d::UnitZ()};
  const IkStatus status = solve(goal, q);
  EXPECT_EQ(status.code, IkStatus::Code::no_convergence);
  EXPECT_GT(status.shortfall, 0.01);
  EXPECT_EQ(status.detail,
            "no depth within the needle's range was found at which the roll comes right");
}

TEST_F(Needle, ARotationLeavesNoDepthToBeGiven) {
  EXPECT_EQ(describe(solve(at_depth(rotation_goal(home_), 0.1), home_)),
            "invalid_input: a full rotation leaves nothing redundant");
}

TEST_F(Needle, ALineOutOfReachSaysByHowMuchAtTheBestDepth) {
  // The wrist's line passes the shoulder at a distance of 2 m.
  IkGoal goal;
  goal.pose = {{2, 0, 0.1}, Direction{{0, 0, 1}}};
  const IkStatus status = solve(goal, home_);
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall, std::sqrt(4 - arm_.d2 * arm_.d2) - arm_.a2 - arm_.forearm, 1e-12);
}

/// Of arms with and without a1 and d2, forearm and upper arm alike or not; lines through a place
/// anywhere up to 1.5 m away, which lead into any direction.
TEST_F(Needle, ALineIsOutOfReachExactlyWhereEveryDepthIs) {
  const ArmKernel kernel = arm_kernels().kernel[0];
  int reached = 0, missed = 0;
  for (int i = 0; i < 5000; ++i) {
    PumaArm arm;
    arm.needle = true;
    arm.a2 = any(0.2, 0.6);
    arm.forearm = any(0, 1) < 0.5 ? any(0.2, 0.6) : arm.a2;
    arm.a1 = any(0, 1) < 0.5 ? any(-0.3, 0.3) : 0;
    arm.d2 = any(0, 1) < 0.7 ? any(-0.3, 0.3) : 0;
    const auto direction = [&] {
      return Eigen::Quaterniond::UnitRandom() * Eigen::Vector3d::UnitZ();
    };
    const Eigen::Vector3d place = any(0, 1.5) * direction(), way = direction();
    PumaGoal goal;
    goal.at_zero.wrist = {place.x(), place.y(), place.z()};
    goal.needle = {way.x(), way.y(), way.z()};
    goal.at_zero.rims.slack = 1e-11;
    const double from = any(-0.3, 0), to = any(0, 0.3);
    double least = 10;
    for (int k = 0; k <= 1000; ++k) {
      const ArmQuestion question = goal.at(std::lerp(from, to, k / 1000.0));
      const double miss = min_miss(arm, question.wrist).by;
      least = std::min(least, miss);
      if (k % 50 != 0) continue;
      FourArms arms;
      kernel.solve(arm, question, arms);
      ASSERT_EQ(miss <= 1e-11, std::ranges::any_of(arms.reached, std::identity{})) << i;
    }
    const double told = nearest_to_reach({kernel, arm, goal, from, to}).miss.by;
    ++(told > 1e-11 ? missed : reached);
    EXPECT_LE(std::max(told, 0.0), std::max(least, 0.0) + 1e-12) << i;
    EXPECT_TRUE(told <= 0 || told >= 0.9 * least - 1e-3) << i;
  }
  EXPECT_GT(std::min(missed, reached), 1000);
}

TEST_F(PumaTest, ADirectionKeepsTheSeedsRollOrTakesTheGivenOne) {
  use(sr1_pointing());
  for (int i = 0; i < 200; ++i) {
    const JointVector q = random_joints();
    IkGoal goal = direction_goal(q);
    EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok);
    EXPECT_EQ(found_.count, 8);
    for (const IkBranch& branch : found_) EXPECT_NEAR(wrap_angle(branch.q[5] - q[5]), 0, 1e-14);
    goal.redundancy = 0.4;
    EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok);
    for (const IkBranch& branch : found_) {
      EXPECT_EQ(branch.q[5], 0.4);
      EXPECT_EQ(branch.redundancy, 0.4);
    }
  }
}

TEST_F(PumaTest, AToolBesideTheAxisOfJoint6NeedsARotation) {
  use(arm_of(sr1()->convention(), sr1()->joints(),
             Eigen::Isometry3d{Eigen::Translation3d{0.01, 0, 0.1}}, Eigen::Vector3d::UnitZ()));
  const JointVector q = JointVector::Constant(6, -0.5);
  EXPECT_EQ(describe(solve(direction_goal(q), q)),
            "invalid_input: a direction needs a tool that lies on the axis of joint 6 and points "
            "along it; give a rotation");
  EXPECT_EQ(solve(rotation_goal(q), q).code, IkStatus::Code::ok);
}

}  // namespace
}  // namespace armature
