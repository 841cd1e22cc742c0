// SPDX-License-Identifier: Apache-2.0
// The workspace of a tip: 1. every point is one that the arm comes to within its limits, 2. with
// the shaft in the incision, 3. an incision out of reach has none.
#include "workspace/workspace_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "armature/config/document.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

class WorkspaceTest : public testing::Test {
 protected:
  const RobotModel arm_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7_scope.yaml");
  const PluginPtr<IkSolver> solver_ =
      std::move(built_plugins()
                    .make<IkSolver>("ik/srs_arm_angle", arm_,
                                    declared_params(ARMATURE_SOURCE_DIR
                                                    "/plugins/ik/srs_arm_angle/plugin.yaml"))
                    .value());

  RemoteCentre centre_behind_home(double depth) const {
    const Eigen::Isometry3d home = forward_kinematics(arm_, resting_position(arm_));
    return {.point = home * Vector3d{0, 0, -depth}, .shaft = *arm_.shaft()};
  }
};

TEST_F(WorkspaceTest, OfAFreeTipIsWhereForwardKinematicsHasIt) {
  const Workspace workspace = free_workspace(arm_, 500, 7);
  ASSERT_EQ(workspace.points.size(), 500u);
  for (const ReachedPoint& point : workspace.points) {
    ASSERT_TRUE(arm_.within_limits(point.q));
    ASSERT_LT((forward_kinematics(arm_, point.q).translation() - point.position).norm(), 1e-12);
  }
}

TEST_F(WorkspaceTest, InAnIncisionHasTheShaftThroughItAndTheTipAsDeepAsTheShaftIsLong) {
  const RemoteCentre centre = centre_behind_home(0.1);
  const Workspace workspace = workspace_about(centre, 0.01, arm_, *solver_, 400, 8);
  EXPECT_GT(workspace.points.size(), 20u);
  EXPECT_LT(workspace.points.size(), 400u) << "the arm does not come to the other side";
  for (const ReachedPoint& point : workspace.points) {
    ASSERT_TRUE(arm_.within_limits(point.q));
    const Eigen::Isometry3d pose = forward_kinematics(arm_, point.q);
    ASSERT_LT((pose.translation() - point.position).norm(), 1e-6);
    ASSERT_LT(centre.deviation(pose), 1e-6);
    ASSERT_GT(centre.depth(pose), 0.01 - 1e-6);
    ASSERT_LT(centre.depth(pose), arm_.shaft()->length + 1e-6);
  }
}

TEST_F(WorkspaceTest, OfAnIncisionOutOfReachIsEmpty) {
  RemoteCentre centre = centre_behind_home(0.1);
  centre.point.x() += 3;
  EXPECT_TRUE(workspace_about(centre, 0.01, arm_, *solver_, 50, 9).points.empty());
}

TEST(FreeWorkspace, HasOneTurnOfAJointThatTurnsWithoutAnEnd) {
  const RobotModel arm = read_robot_model(config::parse_text(
      "armature_robot: 1\n"
      "name: spindle\n"
      "joints:\n"
      "  - {name: reach, type: prismatic, theta_deg: 90, alpha_deg: 90, limits_m: [0.2, 0.3],\n"
      "     velocity_m_s: 1, acceleration_m_s2: 1}\n"
      "  - {name: spin, type: continuous, a_m: 0.1, velocity_rad_s: 1, acceleration_rad_s2: 1}\n"
      "frames: {tool: {parent: spin}}\n",
      "spindle.yaml"));
  const Workspace workspace = free_workspace(arm, 500, 5);
  double lowest = 0, highest = 0;
  for (const ReachedPoint& point : workspace.points) {
    ASSERT_LT((forward_kinematics(arm, point.q).translation() - point.position).norm(), 1e-12);
    lowest = std::min(lowest, point.q[1]);
    highest = std::max(highest, point.q[1]);
  }
  EXPECT_GT(highest - lowest, 1.95 * std::numbers::pi);
  EXPECT_LE(highest - lowest, 2 * std::numbers::pi);
}

TEST_F(WorkspaceTest, IsTheSameForTheSameSeed) {
  const Workspace one = free_workspace(arm_, 20, 3), same = free_workspace(arm_, 20, 3),
                  other = free_workspace(arm_, 20, 4);
  EXPECT_EQ(one.points.back().position, same.points.back().position);
  EXPECT_NE(one.points.back().position, other.points.back().position);
}

}  // namespace
}  // namespace armature
