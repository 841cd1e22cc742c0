// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/task_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

class TaskErrorTest : public ::testing::Test {
 protected:
  ToolPose pose_at(const JointVector& joints, bool pointing) const {
    const Eigen::Isometry3d pose = forward_kinematics(lamp, joints);
    ToolPose goal;
    goal.position = pose.translation();
    if (pointing) {
      goal.orientation = Direction{pose.linear() * *lamp.pointing_axis()};
    } else {
      goal.orientation = Eigen::Quaterniond{pose.linear()};
    }
    return goal;
  }

  const RobotModel lamp = testing::dental_lamp();
  const JointVector q = *lamp.to_independent(*lamp.home());
};

TEST_F(TaskErrorTest, IsTheJacobianTimesASmallStepOfTheJoints) {
  JointVector step(5);
  step << 1, -2, 1.5, 0.5, -1;
  for (const bool pointing : {true, false}) {
    const auto [error, jacobian] = task_error(lamp, q, pose_at(q + 1e-6 * step, pointing));
    ASSERT_EQ(error.size(), pointing ? 5 : 6);
    EXPECT_LE((error - 1e-6 * (jacobian * step)).norm(), 1e-11);
  }
}

TEST_F(TaskErrorTest, TellsTheSameDistancesAsTheResidual) {
  JointVector there(5);
  there << 0.4, -1.2, 0.3, 1.9, -0.5;
  for (const bool pointing : {true, false}) {
    const ToolPose goal = pose_at(there, pointing);
    const TaskError missing = task_error(lamp, q, goal);
    const PoseResidual apart = residual(forward_kinematics(lamp, q), *lamp.pointing_axis(), goal);
    EXPECT_NEAR(missing.position_m(), apart.position_m, 1e-12);
    EXPECT_NEAR(missing.angle_rad(), apart.angle_rad, 1e-12);
  }
}

TEST_F(TaskErrorTest, OfTheOppositeDirectionIsHalfATurn) {
  ToolPose goal = pose_at(q, true);
  std::get<Direction>(goal.orientation).unit *= -1;
  EXPECT_NEAR(task_error(lamp, q, goal).angle_rad(), M_PI, 1e-9);
}

TEST_F(TaskErrorTest, HasTheRowsOfTheRobotsTask) {
  EXPECT_EQ(task_jacobian(lamp, q).rows(), 5);
  const RobotModel turning{{lamp.name(), lamp.convention(), lamp.joints(), lamp.frames(),
                            lamp.tool(), std::nullopt, std::nullopt}};
  EXPECT_EQ(task_jacobian(turning, q).rows(), 6);
}

}  // namespace
}  // namespace armature
