// SPDX-License-Identifier: Apache-2.0
// Limits to plan with: 1. a default gives way to a slower joint, joint by joint, 2. one that was
// written does not, and is refused with its place, 3. so is one with which nothing would move, and
// 4. one from which no stop comes to rest in time.
#include "armature/motion/motion_params.hpp"

#include <gmock/gmock.h>

#include "armature/config/document.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/robot/trajectories/trajectory.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The defaults are 1 rad/s and 2.5 rad/s2: `slow` turns slower, `weak` gathers speed more slowly.
RobotModel uneven_arm() {
  return read_robot_model(config::parse_text(
      "armature_robot: 1\n"
      "name: uneven\n"
      "joints:\n"
      "  - {name: quick, limits_deg: [-90, 90], velocity_rad_s: 3, acceleration_rad_s2: 9}\n"
      "  - {name: slow, limits_deg: [-90, 90], velocity_rad_s: 0.5, acceleration_rad_s2: 9}\n"
      "  - {name: weak, limits_deg: [-90, 90], velocity_rad_s: 3, acceleration_rad_s2: 2}\n"
      "frames: {tool: {parent: weak}}\n",
      "uneven.yaml"));
}

MotionLimits limits_with(const std::string& given) {
  return limits_of(
      declared_params(ARMATURE_SOURCE_DIR "/framework/armature/motion/plugin.yaml", given),
      uneven_arm());
}

TEST(MotionParams, ADefaultThatIsAboveAJointsOwnLimitGivesWayToIt) {
  const MotionLimits limits = limits_with("");
  EXPECT_EQ(limits.max_velocity, (JointVector{Eigen::Vector3d{1, 0.5, 1}}));
  EXPECT_EQ(limits.max_acceleration, (JointVector{Eigen::Vector3d{2.5, 2.5, 2}}));
}

TEST(MotionParams, ALimitThatWasWrittenIsRefusedAboveAJointsOwn) {
  const auto refusal = [](const std::string& given) -> std::string {
    try {
      limits_with(given);
    } catch (const config::ConfigError& error) {
      return error.problems().front().text();
    }
    return "taken";
  };
  EXPECT_EQ(refusal("{max_velocity_rad_s: 0.5, max_acceleration_rad_s2: 2}"), "taken");
  EXPECT_EQ(refusal("{max_velocity_rad_s: 1}"),
            "given:1:22: max_velocity_rad_s is 1, above the 0.5 rad/s of joint slow of robot "
            "uneven");
  EXPECT_EQ(refusal("{max_velocity_rad_s: 0.5, max_acceleration_rad_s2: 2.5}"),
            "given:1:52: max_acceleration_rad_s2 is 2.5, above the 2 rad/s2 of joint weak of robot "
            "uneven");
}

TEST(MotionParams, EveryLimitThatIsWrongIsToldAtOnce) {
  std::vector<std::string> texts;
  try {
    limits_with("{max_velocity_rad_s: 4, max_acceleration_rad_s2: 2.5, max_jerk_m_s3: 1}");
  } catch (const config::ConfigError& error) {
    for (const auto& problem : error.problems()) texts.push_back(problem.text());
  }
  ASSERT_EQ(texts.size(), 3U);
  EXPECT_NE(texts[0].find("above the 3 rad/s of joint quick"), std::string::npos) << texts[0];
  EXPECT_NE(texts[1].find("max_acceleration_rad_s2 is 2.5"), std::string::npos) << texts[1];
  EXPECT_NE(texts[2].find("max_jerk_m_s3 is for joints that slide"), std::string::npos) << texts[2];
}

TEST(MotionParams, ALimitWithWhichNothingWouldMoveIsRefused) {
  const auto told = [](const std::string& given) {
    return test::problems_of([&] { limits_with(given); });
  };
  EXPECT_THAT(told("{max_jerk_rad_s3: 1e-300}"),
              ElementsAre("given:1:19: max_jerk_rad_s3 is 1e-300, and must be at least 0.001, or 0 "
                          "for no limit of its own: nothing would move"));
  EXPECT_THAT(told("{max_tracking_velocity_m_s: 1e-300}"),
              ElementsAre(HasSubstr("must be at least 1e-06, or 0 for no limit of its own")));
  EXPECT_THAT(told("{max_jerk_rad_s3: 0.001, max_tracking_velocity_m_s: 1.0e-6}"), ElementsAre());
  EXPECT_THAT(told("{max_jerk_rad_s3: 0}"), ElementsAre());
}

TEST(MotionParams, LimitsFromWhichNoStopComesToRestInTimeAreRefusedWithWhatItTakes) {
  const auto told = [](const std::string& given, double within_s) {
    return test::problems_of([&] {
      check_stop(
          declared_params(ARMATURE_SOURCE_DIR "/framework/armature/motion/plugin.yaml", given),
          uneven_arm(), seconds(within_s));
    });
  };
  EXPECT_THAT(told("{max_acceleration_rad_s2: 0.25}", 7.2), ElementsAre());
  EXPECT_THAT(
      told("{max_acceleration_rad_s2: 0.25}", 7.1),
      ElementsAre("given:1:27: joint quick of robot uneven takes 7.14 s to stop from 0.886 rad/s "
                  "with 0.25 rad/s2, and 'run: {stop_within_s}' is 7.1; raise that, or "
                  "max_acceleration_rad_s2, or lower max_velocity_rad_s"))
      << "half a turn is too short to come to 1 rad/s";
  EXPECT_THAT(told("{max_acceleration_rad_s2: 0.25, max_velocity_rad_s: 0.5}", 4.1), ElementsAre());
  EXPECT_THAT(told("", 0.8), ElementsAre(HasSubstr("joint quick of robot uneven takes 0.85 s")))
      << "defaults, too";
  EXPECT_THAT(told("{max_jerk_rad_s3: 0.001}", 1),
              ElementsAre(AllOf(HasSubstr("joint weak of robot uneven takes 1.05 s"),
                                testing::EndsWith("raise that, or lower max_velocity_rad_s"))))
      << "a stop heeds no jerk, and more acceleration the robot has not";
}

TEST(MotionParams, AStopTakesNoLongerThanItIsReckonedWith) {
  const JointVector still = JointVector::Zero(1), one = JointVector::Constant(1, 1.0);
  const Trajectory stop = stop_from({still, one, still}, one, 0.25 * one, Time{}, 1);
  EXPECT_GT(stop.duration_s(), 4) << "with 0.25 rad/s2 from its first instant on";
  EXPECT_LE(stop.duration_s(), 2 * 4);
}

}  // namespace
}  // namespace armature
