// SPDX-License-Identifier: Apache-2.0
// The scenario of a biopsy, without topics.
#include "biopsy.hpp"

#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;
using Phase = Biopsy::Phase;
using Report = GoalReport::State;

constexpr Time at(double s) { return Time{} + seconds(s); }

const NeedleLine kPlan{
    {0, 0, 0.05}, {0, 0, -0.03}, {{"artery", {0.01, 0, 0}, {0.01, 0.1, 0}, 0.002}}};

class BiopsyTest : public testing::Test {
 protected:
  static const RobotModel& needle_arm() {
    static const RobotModel model =
        load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
    return model;
  }
  static RegisteredHead good() {
    RegisteredHead head{.fiducial_error_m = 0.0004, .target_error95_m = 0.0005};
    head.robot_T_image =
        Eigen::Translation3d{0.4, 0, 0.2} * Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitX()};
    return head;
  }
  Biopsy task_{{}, needle_arm()};
};

TEST_F(BiopsyTest, GoesFromThePlanToTheTarget) {
  EXPECT_FALSE(task_.wants_registration());
  task_.see_head(kPlan);
  EXPECT_EQ(task_.phase(), Phase::registering);
  EXPECT_TRUE(task_.wants_registration());
  task_.see_registration(good());
  EXPECT_FALSE(task_.wants_registration());
  EXPECT_EQ(task_.phase(), Phase::inserting);
  const auto goal = task_.outgoing_goal(at(0.6));
  ASSERT_TRUE(goal);
  EXPECT_LT((goal->pose.position - Vector3d{0.4, 0.03, 0.2}).norm(), 1e-15);
  EXPECT_LT((std::get<Direction>(goal->pose.orientation).unit - Vector3d{0, 1, 0}).norm(), 1e-15);
  EXPECT_LT((*goal->focus - Vector3d{0.4, -0.05, 0.2}).norm(), 1e-15);
  ASSERT_EQ(goal->forbidden.size(), 1u);
  EXPECT_LT((goal->forbidden[0].to - Vector3d{0.41, 0, 0.3}).norm(), 1e-15);
  EXPECT_EQ(goal->forbidden[0].radius_m, 0.002);
  task_.hear({.goal_id = goal->id, .state = Report::executing}, at(1));
  EXPECT_EQ(task_.phase(), Phase::inserting);
  task_.hear({.goal_id = goal->id, .state = Report::done}, at(5));
  EXPECT_EQ(task_.phase(), Phase::at_target);
}

TEST_F(BiopsyTest, DoesNotTrustMarkersThatFitBadly) {
  task_.see_head(kPlan);
  RegisteredHead head = good();
  head.fiducial_error_m = 0.0012;
  task_.see_registration(head);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "the markers fit to 1.20 mm rms, 1 mm are allowed");
  EXPECT_FALSE(task_.outgoing_goal(at(1)));
}

TEST_F(BiopsyTest, DoesNotApproachATargetThatIsNotKnownWellEnough) {
  task_.see_head(kPlan);
  RegisteredHead head = good();
  head.target_error95_m = 0.0023;
  task_.see_registration(head);
  EXPECT_EQ(task_.trouble(), "the target is known to 2.30 mm (95 %), 1 mm are required");
  head.target_error95_m = NAN;
  Biopsy another{{}, needle_arm()};
  another.see_head(kPlan);
  another.see_registration(head);
  EXPECT_EQ(another.phase(), Phase::refused);
}

TEST_F(BiopsyTest, StopsWithTheReasonWhenTheMotionRefuses) {
  task_.see_head(kPlan);
  task_.see_registration(good());
  const auto goal = task_.outgoing_goal(at(0));
  task_.hear({.goal_id = goal->id, .state = Report::failed, .stage = "path", .reason = "a vessel"},
             at(0.1));
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "path: a vessel");
  EXPECT_FALSE(task_.outgoing_goal(at(5)));
}

TEST_F(BiopsyTest, DoesNotBeginAgainWhenTheNeedleMayBeInTissue) {
  task_.see_head(kPlan);
  task_.see_registration(good());
  const auto goal = task_.outgoing_goal(at(0));
  task_.hear({.goal_id = goal->id, .state = Report::executing}, at(0.1));
  task_.hear(
      {.goal_id = goal->id, .state = Report::failed, .stage = "execution", .reason = "stuck"},
      at(3));
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "execution: stuck");
  EXPECT_FALSE(task_.outgoing_goal(at(9)));
}

TEST_F(BiopsyTest, ARobotWithoutAPointingAxisIsGivenTheRotationNearestToHome) {
  const RobotModel six = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1.yaml");
  const NeedleLine line = moved(kPlan, good().robot_T_image);
  const ToolPose pose = pose_at_target(line, six);
  const Eigen::Matrix3d R{std::get<Eigen::Quaterniond>(pose.orientation)};
  EXPECT_LT((R.col(2) - Vector3d{0, 1, 0}).norm(), 1e-12);
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  const Vector3d home_x = forward_kinematics(six, resting_position(six)).linear().col(0);
  for (int i = 1; i < 36; ++i) {
    const Vector3d turned = Eigen::AngleAxisd{i * M_PI / 18, R.col(2)} * R.col(0);
    EXPECT_LE(turned.dot(home_x), R.col(0).dot(home_x) + 1e-12);
  }
}

}  // namespace
}  // namespace armature::task::biopsy
