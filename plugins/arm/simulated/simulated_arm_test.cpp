// SPDX-License-Identifier: Apache-2.0
// The simulated arm's own part: its lag, and how it brakes without power.
#include "simulated_arm.hpp"

#include <gtest/gtest.h>

namespace armature::arm::simulated {
namespace {

/// 2.5 rad/s and 8 rad/s2 of every joint.
const RobotModel& lamp() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  return model;
}

JointVector value(double v) { return JointVector::Constant(lamp().dof(), v); }

TEST(SimulatedArm, BrakesWithinItsLimitsWithTheSetPointWhereItIs) {
  SimulatedArm arm{lamp(), {}, value(0)};
  Time now;
  for (int k = 1; k <= 400; ++k) {
    const double t = 0.001 * k;
    now = now + seconds(0.001);
    arm.step(now, ServoCommand{now, value(t * t), value(2 * t)});
  }
  ASSERT_NEAR(arm.measured_velocity()[0], 0.8, 1e-9);
  for (int k = 0; k < 500; ++k) {
    const double v = arm.measured_velocity()[0];
    arm.brake(now = now + seconds(0.001));
    ASSERT_LE(v - arm.measured_velocity()[0], 8 * 0.001 + 1e-9);
    ASSERT_EQ(arm.setpoint(), arm.measured());
  }
  EXPECT_FALSE(arm.following());
  EXPECT_EQ(arm.measured_velocity()[0], 0);
}

TEST(SimulatedArm, BrakesFromWhereItIsAndNotFromItsSetPointWhereItLags) {
  SimulatedArm arm{lamp(), {.lag = 0.02}, value(0)};
  Time now;
  for (int k = 1; k <= 600; ++k) {
    now = now + seconds(0.001);
    arm.step(now, ServoCommand{now, value(0.0005 * k), value(0.5)});
  }
  const double q = arm.measured()[0];
  arm.brake(now + seconds(0.001));
  EXPECT_GT(arm.measured()[0], q);
  EXPECT_LT(arm.measured()[0], q + 0.0005);
  EXPECT_EQ(arm.setpoint(), arm.measured());
}

TEST(SimulatedArm, MeasuresWithAFirstOrderLag) {
  SimulatedArm arm{lamp(), {.lag = 0.02}, value(0)};
  Time now;
  for (int k = 1; k <= 600; ++k) {
    now = now + seconds(0.001);
    const double q = 0.5 * 0.001 * k * (k > 200);
    arm.step(now, ServoCommand{now, value(q), value(k > 200 ? 0.5 : 0)});
  }
  EXPECT_NEAR(arm.setpoint()[0] - arm.measured()[0], 0.5 * 0.02, 1e-3);
}

}  // namespace
}  // namespace armature::arm::simulated
