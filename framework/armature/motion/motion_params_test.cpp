// SPDX-License-Identifier: Apache-2.0
// Limits to plan with: 1. a default gives way to a slower joint, joint by joint, 2. one that was
// written does not, and is refused with its place.
#include "armature/motion/motion_params.hpp"

#include <gtest/gtest.h>

#include "armature/config/document.hpp"
#include "armature/kinds/declared_params.hpp"

namespace armature {
namespace {

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

}  // namespace
}  // namespace armature
