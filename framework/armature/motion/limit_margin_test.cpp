// SPDX-License-Identifier: Apache-2.0
// What a solver keeps free to the limits.
#include "armature/motion/limit_margin.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace armature {
namespace {

const RobotModel& needle_arm() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  return model;
}

TEST(LimitMargin, NarrowsEveryJointAtBothEndsAndChangesNothingElse) {
  const auto narrow = narrowed(needle_arm(), {.turning_rad = 0.02, .sliding_m = 0.003});
  ASSERT_TRUE(narrow) << narrow.error().text;
  for (int i = 0; i < needle_arm().dof(); ++i) {
    const double margin = needle_arm().is_revolute(i) ? 0.02 : 0.003;
    EXPECT_NEAR(narrow->lower()[i], needle_arm().lower()[i] + margin, 1e-15);
    EXPECT_NEAR(narrow->upper()[i], needle_arm().upper()[i] - margin, 1e-15);
  }
  EXPECT_EQ(narrow->max_velocity(), needle_arm().max_velocity());
  EXPECT_EQ(narrow->home(), needle_arm().home());
  EXPECT_EQ(narrow->frames().size(), needle_arm().frames().size());
  EXPECT_EQ(narrow->tool(), needle_arm().tool());
}

TEST(LimitMargin, OfNothingIsTheSame) {
  const auto same = narrowed(needle_arm(), {});
  ASSERT_TRUE(same);
  EXPECT_EQ(same->lower(), needle_arm().lower());
  EXPECT_EQ(same->upper(), needle_arm().upper());
}

TEST(LimitMargin, ThatLeavesNothingIsRefusedWithTheJoint) {
  const auto none = narrowed(needle_arm(), {.sliding_m = 5});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("of which a margin of 5000 mm at either end leaves nothing"),
            std::string::npos)
      << none.error().text;
}

TEST(LimitMargin, ThatPutsHomeOutsideIsRefusedWithTheJoint) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  const auto none = narrowed(lamp, {.turning_rad = std::numbers::pi / 4});
  ASSERT_FALSE(none);
  EXPECT_EQ(
      none.error().text,
      "at home joint j2 of robot dental_lamp is at -120 deg, and the margin leaves -115 deg to "
      "115 deg");
}

TEST(LimitMargin, ThatPutsHomeOutsideByLittleTellsByHowMuch) {
  constexpr double kDegree = std::numbers::pi / 180;
  RobotParts parts = needle_arm().parts();
  parts.joints[2].upper = (*parts.home)[2] = 135 * kDegree;
  const auto none = narrowed(RobotModel{parts}, {.turning_rad = 0.01 * kDegree});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text,
            "at home joint j3 of robot sr1_needle is at 135 deg, and the margin leaves -224.99 deg "
            "to 134.99 deg");
}

TEST(LimitMargin, ForJointsThatTheRobotDoesNotHaveIsRefused) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  const auto none = narrowed(lamp, {.sliding_m = 0.001});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text, "a margin for joints that slide, and robot dental_lamp has none");
}

}  // namespace
}  // namespace armature
