// SPDX-License-Identifier: Apache-2.0
// The simulated arm on its topics: 1. what it publishes and how often, 2. commands that it follows,
// holds back or refuses, and what it says of them.
#include <gtest/gtest.h>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::arm::simulated {
namespace {

constexpr double kPeriod_s = 0.001;
const std::string kLamp = ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml";

class SimulatedArmComponentTest : public testing::Test {
 protected:
  void step() {
    arm_.step(now_s_ += kPeriod_s);
    for (const auto& told : arm_.take<msg::String>("operating_state")) state_ = told.data_();
    measured_ = arm_.take<msg::JointState>("measured_js").back();
    setpoint_ = arm_.take<msg::JointState>("setpoint_js").back();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// Switches the drives' power for the next step.
  void power(bool on) {
    msg::Bool message;
    message.data_(on);
    arm_.send("power", message);
  }
  /// A command for the next step.
  msg::JointState command(const JointVector& q, const JointVector& v) const {
    msg::JointState message;
    write_all_joints(lamp_, q, v, Time{} + seconds(now_s_ + kPeriod_s), message);
    return message;
  }
  JointVector measured() const { return lamp_.to_independent(measured_.position_()).value(); }

  const RobotModel lamp_ = load_robot_model(kLamp);
  const JointVector home_ = resting_position(lamp_), still_ = JointVector::Zero(5);
  ComponentHarness arm_{built_plugins(),
                        {.component = "{plugin: arm/simulated}", .robot = config::load(kLamp)}};
  double now_s_ = 5;
  msg::JointState measured_, setpoint_;
  std::string state_;
};

TEST_F(SimulatedArmComponentTest, RunsAtItsRate) {
  EXPECT_EQ(arm_.period(), seconds(0.001));
  const ComponentHarness slow{built_plugins(),
                              {.component = "{plugin: arm/simulated, params: {rate_hz: 250}}",
                               .robot = config::load(kLamp)}};
  EXPECT_EQ(slow.period(), seconds(0.004));
}

TEST_F(SimulatedArmComponentTest, HoldsAtHomeAndTellsAllJointsOnEveryStep) {
  for (int i = 0; i < 10; ++i) {
    arm_.step(now_s_ += kPeriod_s);
    for (const char* output : {"measured_js", "setpoint_js"}) {
      const auto told = arm_.take<msg::JointState>(output);
      ASSERT_EQ(told.size(), 1u) << output;
      EXPECT_EQ(stamp_of(told[0].header_().stamp_()), Time{} + seconds(now_s_));
      EXPECT_EQ(told[0].header_().frame_id_(), "base");
      EXPECT_EQ(told[0].name_(), (std::vector<std::string>{"j1", "j2", "j3", "j4", "j5", "j6"}));
      EXPECT_EQ(lamp_.to_independent(told[0].position_()).value(), home_);
      EXPECT_EQ(told[0].velocity_(), std::vector<double>(6, 0.0));
    }
  }
}

TEST_F(SimulatedArmComponentTest, TellsItsOperatingStateTenTimesASecond) {
  std::size_t told = 0;
  for (int i = 0; i < 1000; ++i) {
    arm_.step(now_s_ += kPeriod_s);
    const auto states = arm_.take<msg::String>("operating_state");
    told += states.size();
    for (const auto& state : states) EXPECT_EQ(state.data_(), "HOLDING");
  }
  EXPECT_EQ(told, 10u);
}

TEST_F(SimulatedArmComponentTest, FollowsFreshCommandsExactlyAndHoldsWhenTheyCease) {
  JointVector q = home_;
  for (int i = 0; i < 200; ++i) {
    const double v = 0.004 * i;  // 4 rad/s2
    q[0] += v * kPeriod_s;
    JointVector rate = still_;
    rate[0] = v;
    arm_.send("servo_jp", command(q, rate));
    step();
    ASSERT_EQ(measured(), q);
  }
  EXPECT_EQ(state_, "ENABLED");
  EXPECT_EQ(arm_.status().state, StatusReporter::State::ok);
  EXPECT_FALSE(arm_.component().stopped());
  steps(400);
  EXPECT_EQ(state_, "HOLDING");
  EXPECT_EQ(measured_.velocity_(), std::vector<double>(6, 0.0));
  EXPECT_TRUE(arm_.component().stopped());
  EXPECT_EQ(
      arm_.status().reason,
      "no command for 0.101 s (command_timeout_s is 0.1); the driver itself was 0.000 s late; "
      "stop number 1");
  for (int i = 0; i < 150; ++i) {
    arm_.send("servo_jp", command(measured(), still_));
    step();
  }
  EXPECT_EQ(state_, "ENABLED") << "it follows again";
  EXPECT_EQ(arm_.status().state, StatusReporter::State::ok);
}

TEST_F(SimulatedArmComponentTest, TheJointThatFollowsMovesWithItsLeader) {
  JointVector q = home_, v = still_;
  q[2] += 0.001;
  v[2] = 1;
  arm_.send("servo_jp", command(q, v));
  steps(50);
  EXPECT_EQ(measured_.position_()[3], -measured_.position_()[2]);
  EXPECT_EQ(measured_.velocity_()[3], -measured_.velocity_()[2]);
}

TEST_F(SimulatedArmComponentTest, SaysWhatACommandAsksBeyondTheLimits) {
  step();
  JointVector q = home_;
  q[0] += 0.5;
  arm_.send("servo_jp", command(q, still_));
  step();
  EXPECT_EQ(arm_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(arm_.status().reason, "the command asks joint j1 for velocity 500 rad/s, limit 2.5");
  EXPECT_LT(std::abs(measured()[0] - home_[0]), 1e-4);
  const auto told = arm_.lines().size();
  for (int i = 0; i < 1000; ++i) {
    arm_.send("servo_jp", command(q, still_));
    step();
  }
  EXPECT_EQ(measured(), q);
  EXPECT_EQ(arm_.status().state, StatusReporter::State::ok);
  EXPECT_EQ(arm_.lines().size(), told + 1) << "told once, and once that it is over";
}

TEST_F(SimulatedArmComponentTest, RefusesACommandThatIsNoneAndStandsStill) {
  steps(10);
  const auto refusal = [&](auto change) {
    msg::JointState bad = command(home_ + JointVector::Constant(5, 0.001), still_);
    change(bad);
    arm_.send("servo_jp", bad);
    steps(150);
    EXPECT_EQ(state_, "FAULT");
    EXPECT_EQ(measured(), home_);
    EXPECT_EQ(arm_.status().state, StatusReporter::State::degraded);
    return arm_.status().reason;
  };
  EXPECT_EQ(refusal([](auto& c) { c.position_().pop_back(); }),
            "refused a command: position: 5 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& c) { c.position_().clear(); }),
            "refused a command: position: 0 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& c) { c.position_().assign(100, 0.0); }),
            "refused a command: position: 100 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& c) { c.position_()[4] = NAN; }),
            "refused a command: position: j5 = nan is not a number");
  EXPECT_EQ(refusal([](auto& c) { c.position_()[3] += 0.1; }),
            "refused a command: position: j4 = 0.099 contradicts its coupling to j3, which makes "
            "it -0.001");
  EXPECT_EQ(refusal([](auto& c) { c.velocity_().clear(); }),
            "refused a command: velocity: 0 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(refusal([](auto& c) { c.velocity_()[0] = INFINITY; }),
            "refused a command: velocity: j1 = inf is not a number");
  for (int i = 0; i < 200; ++i) {
    arm_.send("servo_jp", command(home_, still_));
    step();
  }
  EXPECT_EQ(arm_.status().state, StatusReporter::State::ok);
  EXPECT_EQ(state_, "ENABLED");
}

TEST_F(SimulatedArmComponentTest, ARefusedCommandIsTheTroubleThatIsToldFirst) {
  step();
  JointVector q = home_;
  q[0] += 0.5;
  arm_.send("servo_jp", command(q, still_));
  step();
  ASSERT_EQ(arm_.status().reason, "the command asks joint j1 for velocity 500 rad/s, limit 2.5");
  msg::JointState bad = command(q, still_);
  bad.velocity_().pop_back();
  arm_.send("servo_jp", bad);
  step();
  EXPECT_EQ(arm_.status().reason,
            "refused a command: velocity: 5 joint values; dental_lamp has 6 joints");
  arm_.send("servo_jp", command(q, still_));
  step();
  EXPECT_EQ(arm_.status().reason.substr(0, 30), "the command asks joint j1 for ");
}

TEST_F(SimulatedArmComponentTest, AfterAStopOfItsOwnItWaitsForAReferenceThatComesBackToIt) {
  arm_.send("servo_jp", command(home_, still_));
  steps(200);  // no command for longer than command_timeout_s
  const JointVector far = home_ + JointVector::Constant(5, 0.2);
  for (int i = 0; i < 100; ++i) {
    arm_.send("servo_jp", command(far, still_));
    step();
    ASSERT_EQ(measured(), home_) << i;
  }
  EXPECT_EQ(
      arm_.status().reason,
      "the command for joint j1 is 0.2 rad away from where the arm stopped by itself; it must "
      "come back to 0.1");
  const JointVector near = home_ + JointVector::Constant(5, 0.05);
  for (int i = 0; i < 1000; ++i) {
    arm_.send("servo_jp", command(near, still_));
    step();
  }
  EXPECT_LT((measured() - near).norm(), 1e-9);
  for (int i = 0; i < 2000; ++i) {
    arm_.send("servo_jp", command(far, still_));
    step();
  }
  EXPECT_LT((measured() - far).norm(), 1e-9) << "it follows again";
}

TEST_F(SimulatedArmComponentTest, YieldsToAHandAndFollowsCommandsAgainWhenItLetsGo) {
  JointVector q = home_;
  for (int i = 0; i < 100; ++i) {
    q[1] += 0.002 * std::sin(0.3 * i);  // 2 rad/s at most, 600 rad/s2
    arm_.send("hand_js", command(q, still_));
    arm_.send("servo_jp", command(home_, still_));
    step();
    ASSERT_EQ(measured(), q);
  }
  for (int i = 0; i < 1000; ++i) {
    arm_.send("servo_jp", command(home_, still_));
    step();
  }
  EXPECT_EQ(measured(), home_);
}

TEST_F(SimulatedArmComponentTest, WithoutPowerItBrakesWithinItsLimitsAndFollowsNothing) {
  JointVector q = home_, v = still_;
  v[1] = 0.5;
  for (int i = 0; i < 500; ++i) {
    q[1] += 0.5 * kPeriod_s;
    arm_.send("servo_jp", command(q, v));
    step();
  }
  power(false);
  double speed = measured_.velocity_()[1];
  for (int i = 0; i < 1000; ++i) {
    q[1] += 0.5 * kPeriod_s;
    arm_.send("servo_jp", command(q, v));
    step();
    ASSERT_LE(std::abs(measured_.velocity_()[1] - speed),
              lamp_.max_acceleration()[1] * kPeriod_s * (1 + 1e-9));
    ASSERT_EQ(setpoint_.position_(), measured_.position_()) << "the set point is where the arm is";
    speed = measured_.velocity_()[1];
    ASSERT_EQ(state_, "EMERGENCY_STOP") << "is told at once";
  }
  EXPECT_EQ(speed, 0);
  EXPECT_EQ(arm_.status().reason, "its drives have no power");
}

TEST_F(SimulatedArmComponentTest, WithPowerAgainItFollowsFromWhereItIs) {
  arm_.send("servo_jp", command(home_, still_));
  step();
  power(false);
  JointVector near = home_;
  near[0] += 0.05;
  for (int i = 0; i < 100; ++i) {
    arm_.send("servo_jp", command(near, still_));
    step();
  }
  EXPECT_EQ(measured(), home_);
  power(true);
  for (int i = 0; i < 1000; ++i) {
    arm_.send("servo_jp", command(near, still_));
    step();
    ASSERT_EQ(state_, "ENABLED");
    ASSERT_LE(std::abs(measured_.velocity_()[0]), lamp_.max_velocity()[0]);
  }
  EXPECT_EQ(measured(), near);
  EXPECT_EQ(arm_.status().state, StatusReporter::State::ok);
}

TEST_F(SimulatedArmComponentTest, AnArmWithoutPowerYieldsToAHandStill) {
  power(false);
  JointVector q = home_;
  for (int i = 0; i < 100; ++i) {
    q[1] += 0.0005;
    arm_.send("hand_js", command(q, still_));
    step();
    ASSERT_EQ(measured(), q);
  }
}

TEST_F(SimulatedArmComponentTest, AHandMovesItWithinItsLimitsOnly) {
  JointVector far = home_;
  far[1] += 10;
  for (int i = 0; i < 3000; ++i) {
    arm_.send("hand_js", command(far, still_));
    step();
  }
  EXPECT_NEAR(measured()[1], lamp_.upper()[1], 1e-3);
  EXPECT_EQ(arm_.status().reason.substr(0, 36), "the hand asks joint j2 for position ");
  arm_.send("hand_js", msg::JointState{});
  step();
  EXPECT_EQ(arm_.status().reason,
            "refused a hand: position: 0 joint values; dental_lamp has 6 joints");
  steps(300);
  EXPECT_EQ(arm_.status().reason, "") << "it has let go";
}

TEST_F(SimulatedArmComponentTest, AGoodHandDoesNotHideABadCommand) {
  arm_.send("servo_jp", msg::JointState{});
  arm_.send("hand_js", command(home_, still_));
  step();
  EXPECT_EQ(arm_.status().reason,
            "refused a command: position: 0 joint values; dental_lamp has 6 joints");
}

TEST_F(SimulatedArmComponentTest, TellsTheToolsPoseOfWhatItMeasures) {
  arm_.step(now_s_ += kPeriod_s);
  const auto told = arm_.take<msg::PoseStamped>("measured_cp");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(told[0].header_().stamp_()), Time{} + seconds(now_s_));
  EXPECT_TRUE(to_eigen(told[0].pose_()).isApprox(forward_kinematics(lamp_, home_), 1e-12));
}

TEST_F(SimulatedArmComponentTest, AnOldCommandIsNotFollowed) {
  JointVector q = home_;
  q[0] += 0.01;
  msg::JointState old = command(q, still_);
  write_header(old.header_(), Time{} + seconds(now_s_ - 0.2), kBaseFrame);
  arm_.send("servo_jp", old);
  steps(200);
  EXPECT_EQ(state_, "HOLDING");
  EXPECT_EQ(measured(), home_);
}

TEST_F(SimulatedArmComponentTest, ACommandThatANewerOneHasOvertakenIsNotFollowed) {
  JointVector q = home_;
  q[0] += 1e-6;
  const msg::JointState overtaken = command(home_, still_);
  steps(20);
  for (int i = 0; i < 50; ++i) {
    arm_.send("servo_jp", command(q, still_));
    step();
    arm_.send("servo_jp", overtaken);
    step();
    ASSERT_EQ(measured(), q);
  }
  EXPECT_EQ(state_, "ENABLED");
}

TEST(SimulatedArmComponent, DoesNotStartWithARobotThatNamesNoHome) {
  const config::Node robot = config::parse_text(
      "{armature_robot: 1, name: one, joints: [{name: j1, a_m: 1, limits_deg: [-90, 90], "
      "velocity_rad_s: 1, acceleration_rad_s2: 1}], frames: {tool: {parent: j1}}}",
      "one.yaml");
  EXPECT_EQ(refusal_of(built_plugins(), {.component = "{plugin: arm/simulated}", .robot = robot}),
            "robot one names no home_deg to start from");
}

}  // namespace
}  // namespace armature::arm::simulated
