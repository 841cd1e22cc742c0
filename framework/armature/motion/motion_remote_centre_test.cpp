// SPDX-License-Identifier: Apache-2.0
// Motion of an arm whose shaft is in an incision: 1. what it refuses before anything starts,
// 2. which goals it refuses, with the way out.
#include <limits>

#include "armature/motion/motion_harness_test.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;
using test::goal_message;
using test::motion_with;
using test::plugins;

ComponentHarness::Options pivoting_motion(std::vector<std::string> written = {"incision"}) {
  ComponentHarness::Options options =
      motion_with("remote_centre: true", kMainUnit, std::move(written));
  options.robot = config::parse_text(
      "armature_robot: 1\nname: gantry\njoints:\n"
      "  - {name: z, alpha_deg: -90, type: prismatic, limits_m: [-2, 2], velocity_m_s: 1, "
      "acceleration_m_s2: 2.5}\n"
      "  - {name: y, theta_deg: 90, alpha_deg: 90, type: prismatic, limits_m: [-2, 2], "
      "velocity_m_s: 1, acceleration_m_s2: 2.5}\n"
      "  - {name: x, type: prismatic, limits_m: [-2, 2], velocity_m_s: 1, acceleration_m_s2: "
      "2.5}\n"
      "frames: {tool: {parent: x}}\nshaft: {axis: z, length_mm: 300}\n",
      "gantry.yaml");
  return options;
}

/// Of an arm at its zero, whose shaft comes along x of the base.
class RemoteCentreMotionTest : public testing::Test {
 protected:
  RemoteCentreMotionTest() {
    msg::JointState state;
    write_all_joints(model_, JointVector::Zero(3), JointVector::Zero(3), Time{}, state);
    motion_.send("measured_js", state);
    for (int i = 0; i < 20; ++i) motion_.step(0.001 * i);
  }
  void tell_incision(const Vector3d& point) {
    msg::PointStamped message;
    write_header(message.header_(), {}, kBaseFrame);
    assign(message.point_(), point);
    motion_.send("incision", message);
  }
  /// Why a goal was refused, or "".
  std::string refusal_of_goal(MotionMode mode, bool pointing = false) {
    msg::MotionGoal goal = goal_message(++last_id_, {0, 0, 0});
    goal.mode_(static_cast<std::uint8_t>(mode));
    goal.pointing_(pointing);
    assign(goal.orientation_(),
           Eigen::Quaterniond{forward_kinematics(model_, JointVector::Zero(3)).linear()});
    motion_.send("goal", goal);
    motion_.step(0.02 + 0.001 * static_cast<double>(last_id_));
    std::string reason;
    for (const auto& told : motion_.take<msg::MotionStatus>("status")) {
      if (told.goal_id_() == last_id_ && told.stage_() == "accept") reason = told.reason_();
    }
    return reason;
  }

  ComponentHarness motion_{plugins(), pivoting_motion()};
  const RobotModel model_ = read_robot_model(pivoting_motion().robot.value());
  std::uint64_t last_id_ = 0;
};

TEST_F(RemoteCentreMotionTest, NothingIsTrackedBeforeAnIncisionIsRegisteredAndAnythingIsPlanned) {
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking),
            "the incision is not registered: nothing was told on topic incision");
  EXPECT_EQ(refusal_of_goal(MotionMode::planned), "");
}

TEST_F(RemoteCentreMotionTest, AShaftInItsIncisionIsTrackedAndNothingIsPlannedForIt) {
  tell_incision({-0.1, 0, 0});
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking), "");
  EXPECT_EQ(refusal_of_goal(MotionMode::planned),
            "the shaft is in an incision, about which no planned path pivots: track a target");
  EXPECT_EQ(refusal_of_goal(MotionMode::hold), "");
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking, true),
            "a direction leaves the roll of the shaft open: give the goal a rotation");
}

TEST_F(RemoteCentreMotionTest, AnIncisionBesideTheShaftIsToldWithItsPlaceAndTheWayOut) {
  tell_incision({-0.1, 0.016, 0});
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking),
            "the shaft passes the incision at (-0.1000, 0.0160, 0.0000) m by 16.00 mm, more than "
            "max_incision_offset_mm, 1: register the incision where the shaft is, or bring the "
            "shaft through it");
  tell_incision({-0.1, 0, 0});
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking), "") << "it was registered anew";
}

TEST_F(RemoteCentreMotionTest, AnIncisionThatIsNotFiniteIsNone) {
  tell_incision({-0.1, std::numeric_limits<double>::quiet_NaN(), 0});
  EXPECT_EQ(refusal_of_goal(MotionMode::tracking),
            "the incision's point (-0.1, nan, 0) is not finite; tell it again with three numbers "
            "in metres");
}

TEST(RemoteCentreMotion, ARobotWithoutAShaftIsRefused) {
  const std::string refusal =
      refusal_of(plugins(), motion_with("remote_centre: true", kMainUnit, {"incision"}));
  EXPECT_NE(refusal.find("'remote_centre' needs a shaft, and robot gantry names none; state in its "
                         "file, for example, shaft: {axis: z, length_mm: 250}"),
            std::string::npos)
      << refusal;
}

TEST(RemoteCentreMotion, ASolverThatCannotTrackIsRefusedBeforeAnythingStarts) {
  ComponentHarness::Options options = pivoting_motion();
  const auto at = options.component.find("ik/");
  ASSERT_NE(at, std::string::npos) << options.component;
  options.component.replace(at, options.component.find_first_of(",} ", at) - at, "ik/kdl");
  const std::string refusal = refusal_of(plugins(), options);
  EXPECT_NE(refusal.find("'remote_centre' is for tracked targets only, and 'ik/kdl' cannot track a "
                         "target: its plugin.yaml says 'allocates: true'; choose another 'ik'"),
            std::string::npos)
      << refusal;
}

TEST(RemoteCentreMotion, AnIncisionThatNobodyTellsIsRefused) {
  const std::string refusal = refusal_of(plugins(), pivoting_motion({}));
  EXPECT_NE(refusal.find("'remote_centre' needs an incision, and no component writes 'incision'"),
            std::string::npos)
      << refusal;
}

}  // namespace
}  // namespace armature
