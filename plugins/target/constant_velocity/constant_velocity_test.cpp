// SPDX-License-Identifier: Apache-2.0
// The target filter: 1. it averages a still target, 2. it follows one that moves, 3. it forgets
// outliers and believes a target that stays elsewhere, 4. it learns how much measurements scatter,
// 5. its memory is the State alone, 6. bad input.
#include "constant_velocity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "armature/kinds/target/contract.hpp"
#include "armature/values/angles.hpp"

namespace armature::target::constant_velocity {

INSTANTIATE_TEST_SUITE_P(ConstantVelocity, TargetLaws,
                         testing::Values(TargetSubject{
                             "default", std::make_shared<ConstantVelocity>(Parameters{})}));

namespace {

using Eigen::Vector3d;

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A target seen ten times a second with Gaussian noise.
class Camera {
 public:
  Camera(std::uint64_t seed, double position_sigma, double normal_sigma)
      : random_{seed}, position_{position_sigma}, normal_{normal_sigma} {}
  TargetMeasurement look(double t_s, const Vector3d& position, const Vector3d& normal) {
    return {.stamp = Time{} + seconds(t_s),
            .position = position + position_ * noise(),
            .normal = (normal + normal_ * noise()).normalized(),
            .position_covariance = position_ * position_ * Eigen::Matrix3d::Identity(),
            .normal_covariance =
                normal_ * normal_ * (Eigen::Matrix3d::Identity() - normal * normal.transpose())};
  }

 private:
  Vector3d noise() { return {unit_(random_), unit_(random_), unit_(random_)}; }
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_{0, 1};
  double position_, normal_;
};

const Vector3d kMouth{1.55, 0, 0.45};
const Vector3d kNormal{-1, 0, 0};

TEST(ConstantVelocity, AveragesAStillTarget) {
  const ConstantVelocity filter{{}};
  double position = 0, normal = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    SCOPED_TRACE(run);
    Camera camera{static_cast<std::uint64_t>(run), 0.0015, 1.5 * kRadPerDegree};
    PluginState state;
    TargetEstimate estimate{};
    for (int i = 0; i < 20; ++i) {
      const auto updated = filter.update(camera.look(0.1 * i, kMouth, kNormal), state);
      ASSERT_TRUE(updated) << updated.error().text;
      estimate = *updated;
    }
    EXPECT_EQ(estimate.measurements, 20);
    EXPECT_NEAR(estimate.normal.norm(), 1, 1e-12);
    position += (estimate.position - kMouth).squaredNorm();
    normal += std::pow(angle(estimate.normal, kNormal), 2);
  }
  // One look has sqrt(3) x 1.5 mm = 2.6 mm and sqrt(2) x 1.5 = 2.1 degrees.
  EXPECT_LT(std::sqrt(position / kRuns), 0.0010);
  EXPECT_LT(std::sqrt(normal / kRuns), 0.9 * kRadPerDegree);
}

struct Follow {
  double worst_position = 0, worst_normal = 0;      // while it moves
  double settled_position = 0, settled_normal = 0;  // a second after it stopped
  int rejected = 0;
};

/// The patient moves 50 mm and 10 degrees within one second, as the scene lets him.
Follow follow_a_move(std::uint64_t seed, double position_sigma, double normal_sigma) {
  const ConstantVelocity filter{{}};
  Camera camera{seed, position_sigma, normal_sigma};
  PluginState state;
  Follow result;
  for (int i = 0; i <= 70; ++i) {
    const double t = 0.1 * i, s = std::clamp(t - 4.05, 0.0, 1.0);
    const double share = s * s * s * (10 + s * (-15 + 6 * s));
    const Vector3d mouth = kMouth + share * Vector3d{0, 0.04, 0.03};
    const double turn = 10 * kRadPerDegree * share;
    const Vector3d normal{-std::cos(turn), std::sin(turn), 0};
    const auto estimate = filter.update(camera.look(t, mouth, normal), state);
    if (!estimate) {
      ++result.rejected;
      continue;
    }
    const double position_error = (estimate->position - mouth).norm();
    const double normal_error = angle(estimate->normal, normal);
    if (t > 4.05 && t < 5.5) {
      result.worst_position = std::max(result.worst_position, position_error);
      result.worst_normal = std::max(result.worst_normal, normal_error);
    }
    if (t >= 6.5) {
      result.settled_position = std::max(result.settled_position, position_error);
      result.settled_normal = std::max(result.settled_normal, normal_error);
    }
  }
  return result;
}

TEST(ConstantVelocity, FollowsAPatientWhoMovesFiftyMillimetresAndTenDegreesInASecond) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Follow result = follow_a_move(seed, 0.001, 1.2 * kRadPerDegree);
    EXPECT_EQ(result.rejected, 0);
    EXPECT_LT(result.worst_position, 0.012);
    EXPECT_LT(result.worst_normal, 8 * kRadPerDegree);
    EXPECT_LT(result.settled_position, 0.0025);
    EXPECT_LT(result.settled_normal, 2.5 * kRadPerDegree);
  }
}

TEST(ConstantVelocity, ComesToRestWithThePatientHoweverRarelyHeIsSeen) {
  const ConstantVelocity filter{{}};
  for (const double hz : {2.0, 3.0, 5.0, 10.0, 30.0}) {
    SCOPED_TRACE(hz);
    Camera camera{7, 0.00013, 0.02 * kRadPerDegree};
    PluginState state;
    double fastest = 0, turning = 0;  // from 4 s after his stop on
    for (int i = 0; i < 30 * hz; ++i) {
      const double t = i / hz, share = std::clamp((t - 8.03) / 3, 0.0, 1.0);
      const double turn = 30 * kRadPerDegree * share;
      const auto estimate = filter.update(camera.look(t, kMouth + share * Vector3d{0, 0.15, 0},
                                                      {-std::cos(turn), std::sin(turn), 0}),
                                          state);
      ASSERT_TRUE(estimate) << estimate.error().text;
      if (t < 15) continue;
      fastest = std::max(fastest, estimate->velocity.norm());
      turning = std::max(turning, estimate->normal_rate.norm());
    }
    EXPECT_LT(fastest, 0.003) << "m/s";
    EXPECT_LT(turning, 0.3 * kRadPerDegree) << "rad/s";
  }
}

TEST(ConstantVelocity, FollowsThroughThePapersNoise) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Follow result = follow_a_move(seed, 0.005, 4.5 * kRadPerDegree);
    EXPECT_EQ(result.rejected, 0);
    EXPECT_LT(result.worst_position, 0.04);
    EXPECT_LT(result.settled_position, 0.012);
    EXPECT_LT(result.settled_normal, 9 * kRadPerDegree);
  }
}

TEST(ConstantVelocity, RejectsOneOutlierAndSaysHowFarItIs) {
  const ConstantVelocity filter{{}};
  Camera camera{1, 0.001, 1 * kRadPerDegree};
  PluginState state;
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(filter.update(camera.look(0.1 * i, kMouth, kNormal), state));
  const auto outlier =
      filter.update(camera.look(1.0, kMouth + Vector3d{0.3, 0, 0}, kNormal), state);
  ASSERT_FALSE(outlier);
  EXPECT_THAT(
      outlier.error().text,
      testing::MatchesRegex("outlier: (299|300|301) mm and . degrees from where the target "
                            "should be; a measurement alone is believed within [23]. mm and "
                            "1. degrees"));
  const auto next = filter.update(camera.look(1.1, kMouth, kNormal), state);
  ASSERT_TRUE(next);
  EXPECT_LT((next->position - kMouth).norm(), 0.002);
  EXPECT_EQ(next->measurements, 11);
}

TEST(ConstantVelocity, StartsAgainWhereATargetStays) {
  const ConstantVelocity filter{{}};
  Camera camera{1, 0.001, 1 * kRadPerDegree};
  PluginState state;
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(filter.update(camera.look(0.1 * i, kMouth, kNormal), state));
  const Vector3d elsewhere = kMouth + Vector3d{0, 0.4, 0};
  for (int i = 10; i < 13; ++i) {
    EXPECT_FALSE(filter.update(camera.look(0.1 * i, elsewhere, kNormal), state));
  }
  const auto restarted = filter.update(camera.look(1.3, elsewhere, kNormal), state);
  ASSERT_TRUE(restarted);
  EXPECT_LT((restarted->position - elsewhere).norm(), 0.005);
  EXPECT_EQ(restarted->measurements, 1);
}

TEST(ConstantVelocity, AFaceThatJumpsBy200MillimetresIsAnOutlierHoweverWellItIsSeen) {
  for (const double rate_hz : {10.0, 30.0}) {
    const ConstantVelocity filter{{}};
    Camera camera{3, 0.0001, 0.05 * kRadPerDegree};
    PluginState state;
    for (int i = 0; i < 10; ++i)
      ASSERT_TRUE(filter.update(camera.look(i / rate_hz, kMouth, kNormal), state));
    EXPECT_FALSE(
        filter.update(camera.look(10 / rate_hz, kMouth + Vector3d{0, 0, 0.2}, kNormal), state));
    EXPECT_FALSE(filter.update(
        camera.look(11 / rate_hz, kMouth, Vector3d{-0.7, 0.7, 0}.normalized()), state));
    const auto next = filter.update(camera.look(12 / rate_hz, kMouth, kNormal), state);
    ASSERT_TRUE(next) << next.error().text;
    EXPECT_LT((next->position - kMouth).norm(), 0.001);
  }
}

TEST(ConstantVelocity, OutliersHereAndThereAreNeverBelieved) {
  const ConstantVelocity filter{{}};
  Camera camera{4, 0.001, 1 * kRadPerDegree};
  std::mt19937_64 random{4};
  std::uniform_real_distribution<double> anywhere{-0.5, 0.5};
  PluginState state;
  int believed = 0;
  for (int i = 0; i < 500; ++i) {  // from the second second on a phantom in four of five pictures
    const bool phantom = i >= 10 && i % 5 != 0;
    Vector3d offset = Vector3d::Zero();
    while (phantom && offset.norm() < 0.3)
      offset = {anywhere(random), anywhere(random), anywhere(random)};
    const auto estimate = filter.update(camera.look(0.1 * i, kMouth + offset, kNormal), state);
    believed += estimate && phantom;
    if (!phantom) {
      ASSERT_TRUE(estimate) << i << ": " << estimate.error().text;
      EXPECT_LT((estimate->position - kMouth).norm(), 0.005) << 0.1 * i << " s";
    }
  }
  EXPECT_EQ(believed, 0);
}

TEST(ConstantVelocity, APhantomAloneIsNotBelievedHoweverManyPicturesAreMissingBeforeIt) {
  Camera camera{8, 0.0003, 0.2 * kRadPerDegree};
  for (const double rate_hz : {10.0, 30.0}) {
    for (int missing = 0; missing <= 5; ++missing) {
      for (const double off_m : {0.04, 0.08, 0.1, 0.15, 0.2, 0.25}) {
        SCOPED_TRACE(testing::Message() << "seed 8, " << rate_hz << " Hz, " << missing
                                        << " missing, " << off_m << " m off");
        const ConstantVelocity filter{{}};
        PluginState state;
        double t = 0;
        for (int i = 0; i < 50; ++i, t += 1 / rate_hz)
          ASSERT_TRUE(filter.update(camera.look(t, kMouth, kNormal), state));
        t += missing / rate_hz;
        EXPECT_FALSE(filter.update(camera.look(t, kMouth + Vector3d{0, off_m, 0}, kNormal), state));
        const auto next = filter.update(camera.look(t + 1 / rate_hz, kMouth, kNormal), state);
        ASSERT_TRUE(next) << next.error().text;
        EXPECT_LT((next->position - kMouth).norm(), 0.002);
        EXPECT_LT(next->velocity.norm(), 0.01);
      }
    }
  }
}

TEST(ConstantVelocity, PhantomsThatAreAloneAreNotBelievedWhilePicturesAreLost) {
  Camera camera{9, 0.0003, 0.2 * kRadPerDegree};
  std::mt19937_64 random{9};
  std::uniform_real_distribution<double> share{0, 1};
  std::normal_distribution<double> normal;
  const ConstantVelocity filter{{}};
  PluginState state;
  bool after_phantom = false;
  int phantoms = 0;
  for (int i = 0; i < 5000; ++i) {  // one of three is lost, one of five of the others a phantom
    if (share(random) < 0.33) continue;
    Vector3d offset = Vector3d::Zero();
    if (i >= 10 && !after_phantom && share(random) < 0.2) {
      offset = Vector3d{normal(random), normal(random), normal(random)}.normalized();
      offset *= 0.04 + 0.21 * share(random);
    }
    after_phantom = !offset.isZero();
    phantoms += after_phantom;
    const auto estimate = filter.update(camera.look(0.1 * i, kMouth + offset, kNormal), state);
    if (!estimate) continue;
    ASSERT_LT((estimate->position - kMouth).norm(), 0.002) << "seed 9, " << 0.1 * i << " s";
  }
  EXPECT_GT(phantoms, 300);
}

TEST(ConstantVelocity, ATargetThatHasGoneElsewhereInAGapIsBelievedWhenASecondPictureAgrees) {
  const ConstantVelocity filter{{}};
  Camera camera{10, 0.0003, 0.2 * kRadPerDegree};
  PluginState state;
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(filter.update(camera.look(0.1 * i, kMouth, kNormal), state));
  const Vector3d elsewhere = kMouth + Vector3d{0, 0.08, 0};
  EXPECT_FALSE(filter.update(camera.look(2.4, elsewhere, kNormal), state));
  const auto second = filter.update(camera.look(2.5, elsewhere, kNormal), state);
  ASSERT_TRUE(second) << second.error().text;
  EXPECT_LT((second->position - elsewhere).norm(), 0.002);
  EXPECT_LT(second->velocity.norm(), 0.01);
}

TEST(ConstantVelocity, AFirstMeasurementThatWasAPhantomIsForgottenAtOnce) {
  const ConstantVelocity filter{{}};
  Camera camera{6, 0.001, 1 * kRadPerDegree};
  PluginState state;
  ASSERT_TRUE(filter.update(camera.look(0, kMouth + Vector3d{0.3, 0, 0}, kNormal), state));
  for (int i = 1; i <= 3; ++i) {
    const auto estimate = filter.update(camera.look(0.1 * i, kMouth, kNormal), state);
    ASSERT_TRUE(estimate) << i << ": " << estimate.error().text;
    EXPECT_EQ(estimate->measurements, i);
    EXPECT_LT((estimate->position - kMouth).norm(), 0.005);
  }
}

TEST(ConstantVelocity, WhatIsKnownPoorlyMayBeFarther) {
  const ConstantVelocity filter{{}};
  Camera sharp{7, 0.001, 1 * kRadPerDegree}, dim{7, 0.05, 10 * kRadPerDegree};
  PluginState state;
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(filter.update(sharp.look(0.1 * i, kMouth, kNormal), state));
  const auto look = dim.look(1, kMouth + Vector3d{0, 0.15, 0}, kNormal);
  const auto taken = filter.update(look, state);
  ASSERT_TRUE(taken) << taken.error().text;
  EXPECT_LT((taken->position - kMouth).norm(), 0.005) << "and it counts for little";
}

/// How often a filter says that a target moves faster than 10 mm/s or turns faster than 3
/// degrees/s, and how far its estimate is off, rms, from the fourth second on.
struct Rest {
  double share_moving = 0, position_rms = 0, normal_rms = 0;
};
Rest rest_of(double rate_hz, double understated) {
  constexpr double kPosition = 0.002, kTurn = 0.6 * kRadPerDegree;
  Rest rest;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ConstantVelocity filter{{}};
    Camera camera{seed, kPosition, kTurn};
    PluginState state;
    for (int i = 0; i < 10 * rate_hz; ++i) {
      TargetMeasurement look = camera.look(i / rate_hz, kMouth, kNormal);
      look.position_covariance /= understated * understated;
      look.normal_covariance /= understated * understated;
      const auto estimate = filter.update(look, state);
      if (!estimate || i < 4 * rate_hz) continue;
      ++count;
      rest.share_moving +=
          estimate->velocity.norm() > 0.01 || estimate->normal_rate.norm() > 3 * kRadPerDegree;
      rest.position_rms += (estimate->position - kMouth).squaredNorm();
      rest.normal_rms += std::pow(angle(estimate->normal, kNormal), 2);
    }
  }
  rest.share_moving /= count;
  rest.position_rms = std::sqrt(rest.position_rms / count);
  rest.normal_rms = std::sqrt(rest.normal_rms / count);
  return rest;
}

TEST(ConstantVelocity, LearnsHowMuchMeasurementsScatterAndTakesThatForNoMotion) {
  for (const double rate_hz : {10.0, 30.0}) {
    const Rest stated = rest_of(rate_hz, 1);
    EXPECT_LT(stated.share_moving, 0.002);
    for (const double understated : {3.0, 10.0}) {
      const Rest rest = rest_of(rate_hz, understated);
      std::printf(
          "%g Hz, understated %g times: moving %.3f, %.2f mm, %.2f deg (stated right: %.3f, %.2f, "
          "%.2f)\n",
          rate_hz, understated, rest.share_moving, rest.position_rms * 1e3,
          rest.normal_rms / kRadPerDegree, stated.share_moving, stated.position_rms * 1e3,
          stated.normal_rms / kRadPerDegree);
      EXPECT_LT(rest.share_moving, 0.01);
      EXPECT_LT(rest.position_rms, 1.5 * stated.position_rms);
      EXPECT_LT(rest.normal_rms, 1.5 * stated.normal_rms);
    }
  }
}

TEST(ConstantVelocity, CovariancesOfZeroMakeNoMotionOfNoise) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ConstantVelocity filter{{}};
    Camera camera{seed, 0.001, 0.3 * kRadPerDegree};
    PluginState state;
    int refused = 0;  // until it has learned how much they scatter
    for (int i = 0; i < 60; ++i) {
      TargetMeasurement look = camera.look(0.1 * i, kMouth, kNormal);
      look.position_covariance.setZero();
      look.normal_covariance.setZero();
      const auto estimate = filter.update(look, state);
      if (!estimate) ++refused;
      if (i < 40) continue;
      ASSERT_TRUE(estimate) << i << ": " << estimate.error().text;
      EXPECT_LT(estimate->velocity.norm(), 0.02) << i;
      EXPECT_LT((estimate->position - kMouth).norm(), 0.003) << i;
    }
    EXPECT_LE(refused, 5);
  }
}

TEST(ConstantVelocity, FollowsATargetWhoseMeasurementsScatterMoreThanTheySay) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ConstantVelocity filter{{}};
    Camera camera{seed, 0.001, 0.3 * kRadPerDegree};
    PluginState state;
    double worst = 0;
    for (int i = 0; i < 30 * 8; ++i) {  // still for 4 s, then 50 mm/s
      const double t = i / 30.0;
      const Vector3d mouth = kMouth + std::max(t - 4, 0.0) * Vector3d{0, 0.05, 0};
      TargetMeasurement look = camera.look(t, mouth, kNormal);
      look.position_covariance /= 25;
      look.normal_covariance /= 25;
      const auto estimate = filter.update(look, state);
      ASSERT_TRUE(estimate) << estimate.error().text;
      if (t > 5) worst = std::max(worst, (estimate->position - mouth).norm());
    }
    EXPECT_LT(worst, 0.005) << "seed " << seed;
  }
}

TEST(ConstantVelocity, PredictsAlongTheVelocity) {
  const ConstantVelocity filter{{}};
  Camera camera{1, 0.0002, 0.1 * kRadPerDegree};
  PluginState state;
  const Vector3d velocity{0.02, -0.1, 0.05};
  for (int i = 0; i < 30; ++i) {
    filter.update(camera.look(0.1 * i, kMouth + 0.1 * i * velocity, kNormal), state);
  }
  const auto later = filter.predict(Time{} + seconds(3.1), state);
  ASSERT_TRUE(later);
  EXPECT_LT((later->position - (kMouth + 3.1 * velocity)).norm(), 0.008);
  EXPECT_LT((later->velocity - velocity).norm(), 0.04);
  EXPECT_EQ(later->stamp, Time{} + seconds(3.1));
}

TEST(ConstantVelocity, PredictsNoFurtherThanItsGap) {
  const ConstantVelocity filter{{}};
  PluginState state;
  EXPECT_EQ(filter.predict(Time{}, state).error().text, "no measurement yet");
  Camera camera{1, 0.001, 1 * kRadPerDegree};
  ASSERT_TRUE(filter.update(camera.look(1, kMouth, kNormal), state));
  EXPECT_TRUE(filter.predict(Time{} + seconds(1.9), state));
  EXPECT_EQ(filter.predict(Time{} + seconds(2.5), state).error().text,
            "1.50 s without a measurement, more than 1.00 s");
}

TEST(ConstantVelocity, PredictsNothingForATimeLongBeforeItsNewestMeasurement) {
  const ConstantVelocity filter{{}};
  Camera camera{1, 0.001, 1 * kRadPerDegree};
  PluginState state;
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(filter.update(camera.look(0.1 * i, kMouth, kNormal), state));
  const auto long_before = filter.predict(Time{} + seconds(-8), state);
  ASSERT_FALSE(long_before) << long_before->velocity.norm() << " m/s";
  EXPECT_EQ(long_before.error().text, "9.90 s before the newest measurement, more than 0.10 s");
  const auto shortly = filter.predict(Time{} + seconds(1.85), state);
  ASSERT_TRUE(shortly) << shortly.error().text;
  EXPECT_LT((shortly->position - kMouth).norm(), 0.003);
}

TEST(ConstantVelocity, StartsAgainAfterTheGap) {
  const ConstantVelocity filter{{}};
  PluginState state;
  Camera camera{1, 0.001, 1 * kRadPerDegree};
  ASSERT_TRUE(filter.update(camera.look(1, kMouth, kNormal), state));
  const auto again = filter.update(camera.look(2.5, kMouth + Vector3d{0.5, 0, 0}, kNormal), state);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->measurements, 1);
}

TEST(ConstantVelocity, SaysWhatIsWrongWithAMeasurement) {
  const ConstantVelocity filter{{}};
  Camera camera{5, 0.001, 1 * kRadPerDegree};
  PluginState state;
  ASSERT_TRUE(filter.update(camera.look(1, kMouth, kNormal), state));
  auto bad = camera.look(1.1, kMouth, kNormal);
  bad.position.x() = NAN;
  EXPECT_EQ(filter.update(bad, state).error().text,
            "the measurement is not finite, its normal is no unit vector, or a covariance is none");
  EXPECT_EQ(filter.update(camera.look(0.9, kMouth, kNormal), state).error().text,
            "the measurement is 100.0 ms older than the newest one");
  EXPECT_EQ(filter.update(camera.look(1, kMouth, kNormal), state).error().text,
            "the measurement is 0.0 ms older than the newest one");
}

}  // namespace
}  // namespace armature::target::constant_velocity
