// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/target_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature {
namespace {

using Eigen::Vector3d;

MotionGoal target_at(const Vector3d& position, const Vector3d& velocity) {
  MotionGoal goal{.id = 1, .mode = MotionMode::tracking, .pose = {}};
  goal.pose = {.position = position, .orientation = Direction{Vector3d::UnitX()}};
  goal.velocity = velocity;
  return goal;
}

/// On a circle of 50 mm.
MotionGoal circling(double rate, double t) {
  const double c = std::cos(rate * t), s = std::sin(rate * t);
  return target_at({0.05 * c, 0.05 * s, 0.3}, 0.05 * rate * Vector3d{-s, c, 0});
}

/// [m] How far what is expected `ahead_s` is from the circle's point then, after two seconds in
/// which a target was told every `period_s`.
double miss_on_circle(double rate, double period_s, double ahead_s) {
  TargetMotion motion;
  double t = 0;
  for (; t < 2; t += period_s) motion.see(circling(rate, t), Time{} + seconds(t));
  const Vector3d is = circling(rate, t - period_s + ahead_s).pose.position;
  return (motion.after(ahead_s).position - is).norm();
}

TEST(TargetMotion, GoesOnWithItsVelocityAsLongAsItKeepsIt) {
  TargetMotion motion;
  for (int k = 0; k < 20; ++k) {
    motion.see(target_at({0.002 * k, 0, 0}, {0.1, 0, 0}), Time{} + k * seconds(0.02));
  }
  EXPECT_LT((motion.after(0.7).position - Vector3d{0.038 + 0.07, 0, 0}).norm(), 1e-12);
}

TEST(TargetMotion, GoesOnWithItsAcceleration) {
  TargetMotion motion;
  for (int k = 0; k < 20; ++k) {
    const double t = 0.02 * k;
    motion.see(target_at({t * t / 2, 0, 0}, {t, 0, 0}), Time{} + seconds(t));
  }
  EXPECT_LT((motion.after(0.5).position - Vector3d{0.88 * 0.88 / 2, 0, 0}).norm(), 1e-12);
}

TEST(TargetMotion, ACircleIsForeseenForASecondHoweverOftenItIsTold) {
  for (const double hz : {0.3, 0.9, 1.2}) {
    const double rate = 2 * M_PI * hz;
    for (const double period_s : {0.001, 0.01, 0.02, 0.033}) {
      EXPECT_LT(miss_on_circle(rate, period_s, 0.1), 1e-3) << hz << " Hz, " << period_s << " s";
      EXPECT_LT(miss_on_circle(rate, period_s, 1), 0.015) << hz << " Hz, " << period_s << " s";
    }
    EXPECT_LT(miss_on_circle(rate, 0.1, 0.1), 6e-3) << hz;
  }
}

TEST(TargetMotion, ATurnIsForeseenAsAWayIs) {
  TargetMotion motion;
  MotionGoal goal = target_at({0, 0, 0}, {0, 0, 0});
  double angle = 0;
  for (int k = 0; k <= 100; ++k) {
    const double u = 4 * 0.02 * k;
    angle = 0.5 * std::sin(u);
    goal.pose.orientation = Direction{{std::cos(angle), std::sin(angle), 0}};
    goal.angular_velocity = {0, 0, 2 * std::cos(u)};
    motion.see(goal, Time{} + k * seconds(0.02));
  }
  const double then = 0.5 * std::sin(4 * 2.3);
  const Vector3d unit = std::get<Direction>(motion.after(0.3).orientation).unit;
  EXPECT_LT((unit - Vector3d{std::cos(then), std::sin(then), 0}).norm(), 0.01);
}

TEST(TargetMotion, ATargetAfterASilenceIsANewOne) {
  TargetMotion motion;
  for (int k = 0; k < 20; ++k) {
    motion.see(target_at({0, 0, 0}, {0.05 * k, 0, 0}), Time{} + k * seconds(0.02));
  }
  motion.see(target_at({0, 0, 0}, {0.1, 0, 0}), Time{} + seconds(0.7));
  EXPECT_LT((motion.after(0.5).position - Vector3d{0.05, 0, 0}).norm(), 1e-12);
  // So it is when time goes back.
  motion.see(target_at({0, 0, 0}, {0.2, 0, 0}), Time{});
  EXPECT_LT((motion.after(0.5).position - Vector3d{0.1, 0, 0}).norm(), 1e-12);
}

TEST(TargetMotion, AVelocityThatJumpsIsNotTakenForAnAcceleration) {
  TargetMotion motion;
  int k = 0;
  for (; k < 50; ++k) motion.see(target_at({0, 0, 0}, {0, 0, 0}), Time{} + k * seconds(0.001));
  motion.see(target_at({0, 0, 0}, {1, 0, 0}), Time{} + 50 * seconds(0.001));
  EXPECT_NEAR(motion.after(0.1).position.x(), 0.1, 1e-9);
  for (++k; k < 400; ++k) motion.see(target_at({0, 0, 0}, {1, 0, 0}), Time{} + k * seconds(0.001));
  EXPECT_NEAR(motion.after(0.1).position.x(), 0.1, 3e-3);
}

TEST(TargetMotion, ATargetThatSetsOutAndThenKeepsItsVelocityIsNotHeldBack) {
  // What a filter makes of a face that begins to move, told 50 times a second.
  const double told[] = {0.112, 0.148, 0.172, 0.177, 0.187, 0.173, 0.166, 0.176, 0.179, 0.172,
                         0.171, 0.169, 0.180, 0.188, 0.183, 0.171, 0.168, 0.171, 0.179, 0.171};
  TargetMotion motion;
  int k = 0;
  for (const double velocity : told) {
    motion.see(target_at({0, 0, 0}, {velocity, 0, 0}), Time{} + k++ * seconds(0.02));
    if (k <= 10) continue;
    EXPECT_NEAR(motion.after(0.3).position.x(), 0.3 * velocity, 0.015) << "told " << k;
  }
}

TEST(TargetMotion, OfTwoVelocitiesAtOneInstantTheFirstCounts) {
  TargetMotion motion;
  motion.see(target_at({0, 0, 0}, {0.1, 0, 0}), Time{});
  motion.see(target_at({0, 0, 0}, {0.2, 0, 0}), Time{});
  EXPECT_NEAR(motion.after(0.5).position.x(), 0.05, 1e-12);
}

TEST(TargetMotion, AVelocityThatIsToldInStepsIsNoAcceleration) {
  // Estimates ten times a second, told fifty times a second with the rates of the newest.
  constexpr int kSeed = 4;
  std::mt19937_64 random{kSeed};
  std::normal_distribution<double> noise{0, 0.02};
  TargetMotion motion;
  double velocity = 0;
  for (int k = 0; k < 500; ++k) {
    if (k % 5 == 0) velocity = 0.1 + noise(random);
    motion.see(target_at({0, 0, 0}, {velocity, 0, 0}), Time{} + k * seconds(0.02));
    ASSERT_NEAR(motion.after(0.1).position.x(), 0.1 * velocity, 1e-6) << "seed " << kSeed;
  }
}

TEST(TargetMotion, AVelocityThatJittersHasNoAcceleration) {
  constexpr double kNoise = 0.007;  // [m/s]
  const Vector3d velocity{0.14, 0, 0};
  for (const int period_ms : {1, 20, 33}) {
    std::mt19937_64 random{7};
    std::normal_distribution<double> noise{0, kNoise};
    TargetMotion motion;
    double squares = 0;
    int count = 0;
    for (int t_ms = 0; t_ms < 20'000; t_ms += period_ms, ++count) {
      const double t = 1e-3 * t_ms;
      const Vector3d jitter{noise(random), noise(random), noise(random)};
      motion.see(target_at(t * velocity, velocity + jitter), Time{} + seconds(t));
      squares += (motion.after(0.5).position - (t + 0.5) * velocity).squaredNorm();
    }
    // Twice what the jitter itself would move in half a second.
    EXPECT_LT(std::sqrt(squares / count), 2 * 0.5 * kNoise * std::sqrt(3)) << period_ms << " ms";
  }
}

TEST(TargetMotion, NoiseOnTheVelocityOfATargetAtRestMovesItLittle) {
  constexpr int kSeed = 3;
  std::mt19937_64 random{kSeed};
  std::normal_distribution<double> noise{0, 0.001};
  TargetMotion motion;
  for (int k = 0; k < 500; ++k) {
    motion.see(target_at({0, 0, 0}, {noise(random), noise(random), noise(random)}),
               Time{} + k * seconds(0.02));
    ASSERT_LT(motion.after(0.1).position.norm(), 0.0015) << "seed " << kSeed << ", target " << k;
  }
}

}  // namespace
}  // namespace armature
