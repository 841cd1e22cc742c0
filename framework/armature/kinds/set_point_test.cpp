// SPDX-License-Identifier: Apache-2.0
// A driver and a stream of commands: 1. what can be followed is followed exactly, 2.
// what asks for more is followed within the limits, 3. what ceases is carried on, and ramped down.
#include "armature/kinds/set_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "armature/robot/trajectories/quintic.hpp"

namespace armature {
namespace {

RobotModel one_joint(double limit = 1, double max_acceleration = 8) {
  Joint joint;
  joint.name = "j1";
  joint.lower = -limit;
  joint.upper = limit;
  joint.max_velocity = 2.5;
  joint.max_acceleration = max_acceleration;
  return {{"one_joint",
           RobotModel::Convention::standard,
           {joint},
           {{.name = "tool", .parent_joint = 0}},
           FrameId{0},
           std::nullopt,
           std::nullopt}};
}

JointVector value(double v) { return JointVector::Constant(1, v); }

class SetPointTest : public ::testing::Test {
 protected:
  /// One step of 1 ms; velocity and acceleration are checked from the positions themselves.
  void step(std::optional<ServoCommand> command) {
    now_ = now_ + seconds(0.001);
    arm_.step(now_, command);
    const double q = arm_.position()[0];
    const double v = (q - last_q_) / 0.001;
    EXPECT_LE(std::abs(v), 2.5 + 1e-6);
    EXPECT_LE(std::abs(v - last_v_) / 0.001, 8 + 1e-3);
    EXPECT_LE(std::abs(q), 1);
    last_q_ = q;
    last_v_ = v;
  }
  ServoCommand command(double q, double v = 0) const {
    return {now_ + seconds(0.001), value(q), value(v)};
  }

  RobotModel model_ = one_joint();
  SetPoint arm_{model_, seconds(0.1), seconds(0.001), value(0)};
  Time now_;
  double last_q_ = 0, last_v_ = 0;
};

TEST_F(SetPointTest, HoldsAtHomeWithoutACommand) {
  for (int k = 0; k < 10; ++k) step(std::nullopt);
  EXPECT_EQ(arm_.position(), value(0));
}

TEST_F(SetPointTest, AfterAStandstillOfItsOwnItCatchesUpWithinItsLimits) {
  constexpr double kSpeed = 0.3;
  const auto on_the_way = [&] {
    return ServoCommand{now_, value(kSpeed * to_seconds(now_ - Time{})), value(kSpeed)};
  };
  double q = 0;
  const auto next = [&](double passed_s, const ServoCommand& command) {
    now_ = now_ + seconds(passed_s);
    arm_.step(now_, command);
    return std::exchange(q, arm_.position()[0]);
  };
  for (int k = 0; k < 1000; ++k) next(0.001, on_the_way());
  const ServoCommand last = on_the_way();
  next(0.15, last);
  for (int k = 0; k < 1000; ++k) {
    const double before = next(0.001, on_the_way());
    ASSERT_LE(std::abs(q - before) / 0.001, 2.5 + 1e-6) << k;
  }
  EXPECT_NEAR(q, on_the_way().q[0], 1e-3) << "it is with the commands again";
}

TEST_F(SetPointTest, ExecutesAReachableReferenceExactly) {
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  for (int k = 1; k <= 1200; ++k) {
    const double t = 0.001 * k;
    step(command(move.position(t), move.velocity(t)));
    ASSERT_EQ(arm_.position()[0], move.position(t));
    ASSERT_FALSE(arm_.excess());
  }
}

TEST(SetPoint, DoesNotTakeTheRoundingOfPositionsForAnAcceleration) {
  constexpr double kFar = 4.5, kSlow = 0.01;  // from there, with the limit itself
  const RobotModel model = one_joint(5, kSlow);
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(-kFar)};
  for (int k = 1; k <= 20000; ++k) {
    const double t = 0.001 * k;
    const double q = kSlow * t * t / 2 - kFar;
    const Time now = Time{} + seconds(t);
    arm.step(now, ServoCommand{now, value(q), value(kSlow * t)});
    ASSERT_FALSE(arm.excess()) << "after " << t << " s: " << arm.excess()->wanted;
    ASSERT_EQ(arm.position()[0], q);
  }
}

TEST_F(SetPointTest, FollowsAJumpWithinLimitsAndTellsTheNumber) {
  step(command(0));
  step(command(0.5));
  ASSERT_TRUE(arm_.excess());
  EXPECT_EQ(arm_.excess()->quantity, LimitExcess::Quantity::velocity);
  EXPECT_NEAR(arm_.excess()->wanted, 500, 1e-6);
  EXPECT_EQ(arm_.excess()->limit, 2.5);
  for (int k = 0; k < 1000; ++k) step(command(0.5));
  EXPECT_FALSE(arm_.excess());
  EXPECT_EQ(arm_.position()[0], 0.5);
}

TEST_F(SetPointTest, StopsAtThePositionLimit) {
  for (int k = 0; k < 2000; ++k) step(command(3));
  ASSERT_TRUE(arm_.excess());
  EXPECT_EQ(arm_.excess()->quantity, LimitExcess::Quantity::position);
  EXPECT_NEAR(arm_.position()[0], 1, 1e-3);
}

TEST_F(SetPointTest, NeverExceedsLimitsWhateverIsCommanded) {
  std::mt19937 random{7};
  SCOPED_TRACE("seed 7");
  std::uniform_real_distribution<double> position{-1.5, 1.5}, velocity{-4, 4};
  ServoCommand wild = command(0);
  for (int k = 0; k < 20000; ++k) {
    if (k % 50 == 0) wild = command(position(random), velocity(random));
    wild.stamp = now_ + seconds(0.001);
    step(wild);
  }
}

TEST_F(SetPointTest, KeepsItsLimitsWhereCommandsComeLateAndSomeAreLost) {
  std::mt19937 random{5};
  SCOPED_TRACE("seed 5");
  std::uniform_int_distribution<int> late_ms{0, 20}, lost{0, 9};
  const Quintic move = Quintic::between({0, 0, 0}, {0.9, 0, 0}, 1.2);
  ServoCommand newest = command(0);
  for (int k = 1; k <= 1300; ++k) {
    const Time told = now_ + seconds(0.001) - seconds(0.001 * late_ms(random));
    const double t = std::clamp(to_seconds(told - Time{}), 0.0, 1.2);
    if (lost(random) > 5 && told > newest.stamp) {
      newest = {told, value(move.position(t)), value(move.velocity(t))};
    }
    step(newest);
    ASSERT_NEAR(arm_.position()[0], move.position(std::min(0.001 * k, 1.2)), 0.01);
  }
  EXPECT_NEAR(arm_.position()[0], 0.9, 1e-12);
}

TEST_F(SetPointTest, BehindALossItIsExactlyOnTheStreamAgainWhileItMoves) {
  const Quintic start = Quintic::between({0, 0, 0}, {0.5, 0.5, 0}, 0.5);
  const auto at = [&](int k) {
    const double t = 0.001 * k;
    return t < 0.5 ? command(start.position(t), start.velocity(t)) : command(0.5, 0.5);
  };
  for (int k = 1; k <= 500; ++k) step(k > 150 && k < 210 ? at(150) : at(k));
  for (int k = 501; k <= 1000; ++k) {
    const double q = 0.5 + 0.0005 * (k - 500);
    step(command(q, 0.5));
    if (k > 800) {
      ASSERT_NEAR(arm_.position()[0], q, 1e-9) << k << " ms";
    }
  }
}

TEST_F(SetPointTest, TellsNoTroubleOfAStreamThatKeepsTheLimitsWhereSomeOfItIsLost) {
  std::mt19937 random{7};
  SCOPED_TRACE("seed 7");
  std::uniform_int_distribution<int> lost{0, 9};
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  ServoCommand newest = command(0);
  for (int k = 1; k <= 1200; ++k) {
    const double t = 0.001 * k;
    if (lost(random) > 4) newest = command(move.position(t), move.velocity(t));
    step(newest);
    ASSERT_FALSE(arm_.excess()) << t << " s: " << describe(*arm_.excess(), model_, "it").view();
  }
  EXPECT_NEAR(arm_.position()[0], 0.8, 1e-6);
}

/// A driver whose thread wakes at instants of its own follows a motion that uses all of the
/// acceleration: it keeps near, and does not come beyond the end.
TEST(SetPoint, FollowsAStreamAtItsLimitsThoughItsOwnStepsAreUneven) {
  constexpr double kWay = 0.02, kLimit = 0.2, kPeakOfQuintic = 10 / std::numbers::sqrt3;
  const double duration = std::sqrt(kPeakOfQuintic * kWay / kLimit);
  const Quintic move = Quintic::between({0, 0, 0}, {kWay, 0, 0}, duration);
  const RobotModel model = one_joint(1, kLimit);
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> late_s{0, 1e-4};
    SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
    for (int k = 1; 0.001 * k < duration + 0.3; ++k) {
      if (k >= 600 && k < 605) continue;  // once it wakes late while the joint brakes
      const double told_s = 0.001 * k + late_s(random), now_s = told_s + 2e-5;
      const double t = std::min(told_s, duration), now = std::min(now_s, duration);
      arm.step(
          Time{} + seconds(now_s),
          ServoCommand{Time{} + seconds(told_s), value(move.position(t)), value(move.velocity(t))});
      ASSERT_LT(arm.position()[0], kWay + 1e-6) << k << " ms";
      ASSERT_NEAR(arm.position()[0], move.position(now), k < 590 ? 1e-6 : 5e-5) << k << " ms";
    }
    EXPECT_NEAR(arm.position()[0], kWay, 1e-9);
  }
}

/// Instants of a thread that is held up now and then, by up to 50 ms, and catches up at once.
class HeldUpThread {
 public:
  explicit HeldUpThread(unsigned seed) : random_{seed} {}
  double next_step_s() {
    return to_seconds(seconds(1e-6 * std::pow(5e4, part_(random_) * part_(random_))));
  }
  double part() { return part_(random_); }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> part_{0, 1};
};

TEST(SetPoint, ExecutesAReachableReferenceExactlyWhateverItsStepsAre) {
  const RobotModel model = one_joint();
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    HeldUpThread thread{seed};
    SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
    for (Time now = Time{} + seconds(0.001); now < Time{} + seconds(1.2);
         now = now + seconds(thread.next_step_s())) {
      const double t = to_seconds(now - Time{});
      arm.step(now, ServoCommand{now, value(move.position(t)), value(move.velocity(t))});
      ASSERT_EQ(arm.position()[0], move.position(t)) << t << " s";
      ASSERT_FALSE(arm.excess()) << t << " s";
    }
  }
}

TEST(SetPoint, NeverExceedsLimitsWhateverIsCommandedAndItsStepsAre) {
  const RobotModel model = one_joint();
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    HeldUpThread thread{seed};
    SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
    std::optional<ServoCommand> command;
    Time now;
    arm.step(now, command);
    double v_before = 0, before_s = 0.001;
    for (int k = 0; k < 20'000; ++k) {
      const double dt = thread.next_step_s(), q = arm.position()[0];
      now = now + seconds(dt);
      if (thread.part() < 0.05) {
        command = ServoCommand{now, value(2 * thread.part() - 1), value(6 * thread.part() - 3)};
      }
      if (thread.part() < 0.01) command.reset();
      arm.step(now, command);
      const double v = (arm.position()[0] - q) / dt, rounded = 1e-15 / std::min(dt, before_s);
      ASSERT_LE(std::abs(arm.position()[0]), 1);
      ASSERT_LE(std::abs(v), 2.5 + 1e-6 + rounded) << k;
      ASSERT_LE(std::abs(v - v_before), 8 * 0.5 * (dt + before_s) + 1e-6 + rounded)
          << k << ": " << dt << " s behind " << before_s << " s, at " << q << ", " << v;
      v_before = v;
      before_s = dt;
    }
  }
}

TEST(SetPoint, BrakesFromItsSpeedThoughTheStepBeforeWasALateOne) {
  const RobotModel model = one_joint(5);
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const auto at = [](double t) { return Time{} + seconds(t); };
  for (int k = 1; k <= 500; ++k) {
    const double t = 0.001 * k;
    arm.step(at(t), ServoCommand{at(t), value(t * t), value(2 * t)});
  }
  arm.step(at(0.55), ServoCommand{at(0.55), value(0.3025), value(1.1)});
  const double v = arm.position()[0] - 0.25 > 0 ? (arm.position()[0] - 0.25) / 0.05 : 0;
  arm.step(at(0.551), std::nullopt);
  EXPECT_NEAR(arm.velocity()[0], v - 8 * 0.001, 1e-6);
}

TEST_F(SetPointTest, FollowsPositionsExactlyThatComeWithoutVelocities) {
  for (int k = 1; k <= 3000; ++k) {
    const double wanted = 0.5 * (1 - std::cos(0.002 * k));  // up to 1 rad/s and 2 rad/s2
    step(command(wanted));
    ASSERT_NEAR(arm_.position()[0], wanted, 1e-12) << k;
  }
  EXPECT_TRUE(arm_.why().empty());
}

TEST(SetPoint, ComesToRestWithinItsLimitsWhereverOneStepOnTheWayIsALateOne) {
  const RobotModel model = one_joint(0.5, 5);
  constexpr double kPeriod_s = 0.001;
  for (const double target : {0.3, 0.5, 0.6}) {
    for (const double late_s : {0.0, 0.02, 0.09, 0.3}) {
      for (int late_step = 1; late_step < 900; late_step += 3) {
        SetPoint arm{model, seconds(0.1), seconds(kPeriod_s), value(0)};
        double t = 1, q = 0, v = 0, dt = kPeriod_s, worst = 0;
        for (int k = 1; k < 1300; ++k) {
          const double before = std::exchange(dt, kPeriod_s + (k == late_step ? late_s : 0));
          t += dt;
          const Time now = Time{} + seconds(t);
          arm.step(now, ServoCommand{now, value(target), value(0)});
          const double v_before = std::exchange(v, (arm.position()[0] - q) / dt);
          worst = std::max(worst, std::abs(v - v_before) / (0.5 * (before + dt)));
          q = arm.position()[0];
        }
        ASSERT_LE(worst, 5 * (1 + 1e-6)) << target << ", late by " << late_s << " s, " << late_step;
        EXPECT_NEAR(q, std::min(target, 0.5), 1e-9);
      }
    }
  }
}

TEST(SetPoint, AJumpBehindALongPauseOfItsOwnThreadIsOne) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const auto at = [](double t) { return Time{} + seconds(t); };
  arm.step(at(0.001), ServoCommand{at(0.001), value(0), value(0)});
  arm.step(at(10), ServoCommand{at(10), value(0), value(0)});
  arm.step(at(10.001), ServoCommand{at(10.001), value(0.002), value(2)});
  ASSERT_TRUE(arm.excess());
  EXPECT_LE(arm.velocity()[0], 8 * 0.051);
}

TEST_F(SetPointTest, RampsDownAndHoldsWhenThereIsNoCommandAnyMore) {
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  for (int k = 1; k <= 400; ++k) {
    step(command(move.position(0.001 * k), move.velocity(0.001 * k)));
  }
  EXPECT_GT(arm_.velocity()[0], 0.5);
  for (int k = 0; k < 500; ++k) step(std::nullopt);
  EXPECT_EQ(arm_.velocity()[0], 0);
  const double held = arm_.position()[0];
  for (int k = 0; k < 100; ++k) step(std::nullopt);
  EXPECT_EQ(arm_.position()[0], held);
}

TEST_F(SetPointTest, CommandsThatCeaseBeforeALimitLeaveTheJointTheWayToStop) {
  const Quintic move = Quintic::between({0, 0, 0}, {1, 0, 0}, 0.85);
  for (int last = 50; last < 850; last += 50) {
    arm_.be_at(value(0), value(0));
    last_q_ = last_v_ = 0;
    ServoCommand newest = command(0);
    for (int k = 1; k <= last + 100; ++k) {
      const double t = 0.001 * k;
      if (k <= last) newest = command(move.position(t), move.velocity(t));
      step(newest);
    }
    for (int k = 0; k < 500; ++k) step(std::nullopt);
    EXPECT_EQ(arm_.velocity()[0], 0) << "ceased after " << last << " ms";
  }
}

TEST(SetPoint, AJointThatStandsBeyondALimitComesBackButGoesNoFurther) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(1.01)};
  Time now;
  const auto to = [&](double q) {
    now = now + seconds(0.001);
    arm.step(now, ServoCommand{now, value(q), value(0)});
  };
  to(1.01);
  EXPECT_EQ(arm.position()[0], 1.01);
  EXPECT_FALSE(arm.excess());
  for (int k = 0; k < 100; ++k) to(1.0105);
  EXPECT_EQ(arm.position()[0], 1.01);
  EXPECT_EQ(arm.excess()->quantity, LimitExcess::Quantity::position);
  EXPECT_EQ(arm.far_beyond(value(1.0105)).view(), "");
  EXPECT_EQ(arm.far_beyond(value(1.02)).view(),
            "it asks joint j1 for position 1.02 rad, limit 1.01");
  for (int k = 0; k < 1000; ++k) to(0.99);
  EXPECT_EQ(arm.position()[0], 0.99);
  EXPECT_EQ(arm.far_beyond(value(1.01)).view(), "it asks joint j1 for position 1.01 rad, limit 1")
      << "it is back";
}

TEST(SetPoint, CarriesACommandOnForNoLongerThanItsTimeout) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const auto at = [](double t) { return Time{} + seconds(t); };
  arm.step(at(0.001), ServoCommand{at(0.001), value(0), value(0)});
  arm.step(at(0.101), ServoCommand{at(0.101), value(0.02), value(0.4)});
  arm.step(at(0.901), ServoCommand{at(0.101), value(0.02), value(0.4)});  // paused itself
  EXPECT_LE(arm.position()[0], 0.02 + 0.4 * 0.1 + 1e-9);
}

TEST(SetPoint, YieldsToAHandWithinItsLimitsOfPositionAndVelocity) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  Time now;
  const auto guide = [&](double q) { arm.guide(now = now + seconds(0.001), value(q)); };
  guide(0.002);
  EXPECT_EQ(arm.position()[0], 0.002) << "2 rad/s at once: a hand is strong";
  EXPECT_NEAR(arm.velocity()[0], 2, 1e-12);
  EXPECT_FALSE(arm.excess());
  guide(0.5);
  EXPECT_NEAR(arm.position()[0], 0.0045, 1e-12);
  EXPECT_EQ(arm.excess()->quantity, LimitExcess::Quantity::velocity);
  for (int k = 0; k < 1000; ++k) guide(1.5);
  EXPECT_EQ(arm.position()[0], 1);
  EXPECT_EQ(arm.velocity()[0], 0);
  EXPECT_EQ(arm.excess()->quantity, LimitExcess::Quantity::position);
}

TEST(SetPoint, FollowsACommandStreamThatIsSampledAtOtherInstants) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  std::mt19937 random{11};
  SCOPED_TRACE("seed 11");
  std::uniform_int_distribution<int> jitter{0, 400'000};
  for (int k = 1; k <= 1200; ++k) {
    const Time now{k * 1'000'000LL + jitter(random)};
    const double t = 0.001 * k;
    arm.step(now,
             ServoCommand{Time{k * 1'000'000LL}, value(move.position(t)), value(move.velocity(t))});
    ASSERT_FALSE(arm.excess()) << "at " << t;
  }
}

TEST(SetPoint, FollowsACommandStreamAcrossAPauseOfItsOwnThread) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const Quintic move = Quintic::between({0, 0, 0}, {0.8, 0, 0}, 1.2);
  const auto follow = [&](double command_s, double now_s) {
    arm.step(Time{} + seconds(now_s),
             ServoCommand{Time{} + seconds(command_s), value(move.position(command_s)),
                          value(move.velocity(command_s))});
    ASSERT_FALSE(arm.excess()) << "commanded at " << command_s << ", executed at " << now_s;
  };
  for (int k = 1; k < 250; ++k) follow(0.001 * k, 0.001 * k + 2e-5);
  follow(0.250, 0.258);    // stopped for 8 ms between the command and its execution
  follow(0.2581, 0.2582);  // and the next command comes at once
  follow(0.259, 0.2591);
}

TEST(SetPoint, RefusesAJumpInACommandStreamThatIsSampledAtOtherInstants) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const auto at = [](double t) { return Time{} + seconds(t); };
  arm.step(at(0.0011), ServoCommand{at(0.001), value(0), value(0)});
  arm.step(at(0.0021), ServoCommand{at(0.002), value(0.01), value(0)});
  ASSERT_TRUE(arm.excess());
  EXPECT_EQ(arm.excess()->quantity, LimitExcess::Quantity::acceleration);
  EXPECT_LT(arm.position()[0], 0.001);
}

TEST(SetPoint, RefusesAJumpBetweenTwoCommandsOfOneStamp) {
  const RobotModel model = one_joint();
  SetPoint arm{model, seconds(0.1), seconds(0.001), value(0)};
  const auto at = [](double t) { return Time{} + seconds(t); };
  arm.step(at(0.0011), ServoCommand{at(0.001), value(0), value(0)});
  arm.step(at(0.0021), ServoCommand{at(0.001), value(0.01), value(0)});
  ASSERT_TRUE(arm.excess());
  EXPECT_LT(arm.position()[0], 0.001);
}

}  // namespace
}  // namespace armature
