// SPDX-License-Identifier: Apache-2.0
#include "fold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/ik/test_goals.hpp"

namespace armature::ik::numeric {
namespace {

/// A shoulder of three turns, an elbow and a wrist of three, as an arm has them.
RobotModel limb() {
  std::vector<Joint> joints;
  for (const auto& [d, alpha_deg] :
       {std::pair{0.34, -90}, {0.0, 90}, {0.4, 90}, {0.0, -90}, {0.4, -90}, {0.0, 90}, {0.1, 0}}) {
    joints.push_back({.name = "j" + std::to_string(joints.size() + 1),
                      .d = d,
                      .alpha = alpha_deg * M_PI / 180,
                      .lower = -3,
                      .upper = 3,
                      .max_velocity = 1,
                      .max_acceleration = 1});
  }
  return {{"limb",
           RobotModel::Convention::standard,
           std::move(joints),
           {{"tool", 6, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

const JointVector kStretched = Eigen::Matrix<double, 7, 1>{0.3, 0.8, 0, 0, 0, 0.9, 0.5};

/// The elbow bent by `elbow`, shoulder and wrist turned back by half of that each.
JointVector bent(double elbow) {
  JointVector q = kStretched;
  q[3] = elbow, q[1] += 0.5 * elbow, q[5] += 0.5 * elbow;
  return q;
}

TEST(FoldStep, StraightensAnArmThatIsToBeStretched) {
  const RobotModel model = limb();
  const auto step = fold_step(model, test::goal_at(model, kStretched), 0, bent(0.02));
  ASSERT_TRUE(step);
  EXPECT_LE(std::abs(0.02 + (*step)[3]), 0.002);
}

TEST(FoldStep, BendsAnArmOnlyAsFarAsAGoalWithinReachAsks) {
  const RobotModel model = limb();
  const auto step = fold_step(model, test::goal_at(model, bent(0.01)), 0, bent(0.02));
  ASSERT_TRUE(step);
  EXPECT_NEAR(0.02 + (*step)[3], 0.01, 0.002);
}

TEST(FoldStep, LeavesAFixedElbowAsItIs) {
  const RobotModel model = limb();
  const auto step = fold_step(model, test::goal_at(model, kStretched), 1U << 3, bent(0.02));
  EXPECT_TRUE(!step || (*step)[3] == 0);
}

TEST(FoldStep, IsNoneForAGoalThatAnArmReachesByBendingMore) {
  const RobotModel model = limb();
  EXPECT_FALSE(fold_step(model, test::goal_at(model, bent(0.03)), 0, bent(0.02)));
}

TEST(FoldStep, IsNoneForAnArmWithFewerJointsThanTheGoalHasRows) {
  auto joints = limb().joints();
  joints.resize(5);
  const RobotModel model{{"short",
                          RobotModel::Convention::standard,
                          joints,
                          {{"tool", 4, Eigen::Isometry3d::Identity()}},
                          FrameId{0},
                          {},
                          {}}};
  const JointVector q = JointVector::Constant(5, 0.3);
  EXPECT_FALSE(fold_step(model, test::goal_at(model, q), 0, q.array() + 0.01));
}

}  // namespace
}  // namespace armature::ik::numeric
