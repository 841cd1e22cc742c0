// SPDX-License-Identifier: Apache-2.0
#include "descent.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik::numeric::descent {
namespace {

class KernelTest : public testing::TestWithParam<const Kernel*> {
 protected:
  RobotModel model_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  Chain chain_ = chain_of(model_);
  std::mt19937_64 random_{4};

  JointVector joints() {
    JointVector q(model_.dof());
    for (double& value : q) value = std::uniform_real_distribution{-3.0, 3.0}(random_);
    return q;
  }
  IkGoal goal_at(const JointVector& q, bool pointing) const {
    const Eigen::Isometry3d pose = forward_kinematics(model_, q);
    IkGoal goal;
    goal.pose.position = pose.translation();
    if (pointing) {
      goal.pose.orientation = Direction{pose.linear() * *model_.pointing_axis()};
    } else {
      goal.pose.orientation = Eigen::Quaterniond{pose.linear()};
    }
    return goal;
  }
};

TEST_P(KernelTest, MeasuresWhatForwardKinematicsSays) {
  SCOPED_TRACE("seed 4");
  const Eigen::Vector3d axis = *model_.pointing_axis();
  for (int i = 0; i < 2000; ++i) {
    const IkGoal goal = goal_at(joints(), i % 2 == 0);
    const JointVector q = joints();
    const PoseResidual left = residual(forward_kinematics(model_, q), axis, goal.pose);
    const double chord = 2 * std::sin(0.5 * left.angle_rad);
    EXPECT_NEAR(GetParam()->measure(chain_, goal_of(goal), q.data()),
                std::hypot(left.position_m, chord), 1e-9);
  }
}

TEST_P(KernelTest, MeasuresNothingAtTheGoalAndTwoOppositeToIt) {
  const JointVector q = joints();
  IkGoal goal = goal_at(q, false);
  EXPECT_NEAR(GetParam()->measure(chain_, goal_of(goal), q.data()), 0, 1e-14);
  auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
  rotation = rotation * Eigen::AngleAxisd{std::numbers::pi, Eigen::Vector3d{0.6, 0, 0.8}};
  EXPECT_NEAR(GetParam()->measure(chain_, goal_of(goal), q.data()), 2, 1e-9);
  goal = goal_at(q, true);
  auto& direction = std::get<Direction>(goal.pose.orientation);
  direction.unit = -direction.unit;
  EXPECT_NEAR(GetParam()->measure(chain_, goal_of(goal), q.data()), 2, 1e-9);
}

TEST_P(KernelTest, MeasuresNearlyHalfATurn) {
  SCOPED_TRACE("seed 4");
  const Eigen::Vector3d axis{0.6, 0, 0.8};
  for (const double short_by : {1e-1, 1e-2, 2e-3, 1e-3, 1e-4, 1e-7, 1e-9, 0.0, -1e-5, -1e-3}) {
    const JointVector q = joints();
    IkGoal goal = goal_at(q, false);
    auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    rotation = rotation * Eigen::AngleAxisd{std::numbers::pi - short_by, axis};
    EXPECT_NEAR(GetParam()->measure(chain_, goal_of(goal), q.data()), 2 * std::cos(short_by / 2),
                1e-9)
        << short_by;
  }
}

TEST_P(KernelTest, EndsAtTheGoalFromNearby) {
  SCOPED_TRACE("seed 4");
  for (int i = 0; i < 500; ++i) {
    const JointVector q = joints();
    End end;
    for (int j = 0; j < model_.dof(); ++j) end.q[static_cast<std::size_t>(j)] = q[j] + 1e-3;
    int budget = 50;
    GetParam()->descend(chain_, goal_of(goal_at(q, true)), budget, end);
    ASSERT_TRUE(end.reached) << q.transpose();
    const JointVector reached = Eigen::Map<const Eigen::VectorXd>(end.q.data(), model_.dof());
    EXPECT_NEAR(std::sqrt(end.gram), manipulability(model_, reached), 1e-9);
    EXPECT_GE(budget, 40);
  }
}

INSTANTIATE_TEST_SUITE_P(Compiled, KernelTest, testing::Values(&portable_kernel(), &kernel()),
                         [](const auto& kernel) {
                           return kernel.index == 0 ? "Portable" : "Fastest";
                         });

}  // namespace
}  // namespace armature::ik::numeric::descent
