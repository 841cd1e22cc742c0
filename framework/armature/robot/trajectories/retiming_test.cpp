// SPDX-License-Identifier: Apache-2.0
// A planned motion, braked, gone on with and gone back, on its path.
#include "armature/robot/trajectories/retiming.hpp"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "armature/robot/trajectories/quintic_spline.hpp"

namespace armature {
namespace {

constexpr Time kStart{5'000'000'000};
constexpr int kJoints = 3;

/// Random ways from rest to rest over a stop in their midst, which use the limits to the full.
class RetimingTest : public ::testing::Test {
 protected:
  static JointVector all(double value) { return JointVector::Constant(kJoints, value); }
  Trajectory half(const JointVector& from, const JointVector& to) {
    JointVector between = 0.5 * (from + to);
    for (double& q : between) q += uniform_(random_);
    const std::vector<double> knots{0, 1, 2};
    const std::vector<JointVector> points{from, between, to};
    const JointVector none = all(0);
    Trajectory made{.goal_id = 7,
                    .dof = kJoints,
                    .start = kStart,
                    .knots = knots,
                    .pieces = quintic_spline(knots, points, {from, none, none}, {to, none, none})};
    const LimitUse use = limit_use(made, limits_.max_velocity, limits_.max_acceleration);
    return stretched(made, std::max(use.velocity, std::sqrt(use.acceleration)));
  }
  JointVector anywhere() {
    JointVector q(kJoints);
    for (double& value : q) value = uniform_(random_);
    return q;
  }
  Trajectory way() {
    const JointVector a = anywhere(), b = anywhere(), c = anywhere();
    Trajectory first = half(a, b);
    const Trajectory second = half(b, c);
    stop_s_ = first.duration_s();
    for (std::size_t k = 1; k < second.knots.size(); ++k) {
      first.knots.push_back(stop_s_ + second.knots[k]);
    }
    first.pieces.insert(first.pieces.end(), second.pieces.begin(), second.pieces.end());
    return first;
  }
  static JointState at(const Trajectory& trajectory, double t) {
    return trajectory.at(trajectory.start + seconds(t));
  }
  static double place(double share, const Trajectory& way) { return share * way.duration_s(); }
  /// The distance [rad] of `q` from the path of `way`.
  static double off_path(const Trajectory& way, const JointVector& q) {
    double nearest = INFINITY, place_s = 0;
    for (double step = way.duration_s() / 500, from = 0, to = way.duration_s(); step > 1e-7;
         from = place_s - step, to = place_s + step, step /= 20) {
      for (double t = from; t <= to; t += step) {
        const double off = (at(way, t).q - q).norm();
        if (off < nearest) nearest = off, place_s = t;
      }
    }
    return nearest;
  }
  void expect_no_jump_and_within_limits(const Trajectory& driven) {
    for (std::size_t k = 1; k + 1 < driven.knots.size(); ++k) {
      for (int j = 0; j < kJoints; ++j) {
        const auto after = k * kJoints + static_cast<std::size_t>(j);
        const Quintic& next = driven.pieces[after];
        const Quintic& before = driven.pieces[after - kJoints];
        const double lasts = driven.knots[k] - driven.knots[k - 1];
        EXPECT_NEAR(before.position(lasts), next.position(0), 1e-9);
        EXPECT_NEAR(before.velocity(lasts), next.velocity(0), 1e-8);
        EXPECT_NEAR(before.acceleration(lasts), next.acceleration(0), 1e-6);
      }
    }
    const LimitUse use = limit_use(driven, limits_.max_velocity, limits_.max_acceleration);
    EXPECT_LE(use.velocity, 1.00001);
    EXPECT_LE(use.acceleration, 1.00001);
  }
  void expect_near(const JointState& a, const JointState& b) {
    EXPECT_LT((a.q - b.q).norm(), 1e-9);
    EXPECT_LT((a.v - b.v).norm(), 1e-8);
    EXPECT_LT((a.a - b.a).norm(), 1e-6);
  }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  const MotionLimits limits_{.max_velocity = all(0.5), .max_acceleration = all(1)};
  double stop_s_ = 0;
};

TEST_F(RetimingTest, APartIsTheSameMotion) {
  const Trajectory whole = way();
  const double from = place(0.2, whole), to = place(0.7, whole);
  const Trajectory middle = part(whole, from, to);
  EXPECT_NEAR(middle.duration_s(), to - from, 1e-12);
  for (double t = 0; t < to - from; t += 0.05) expect_near(at(middle, t), at(whole, from + t));
  expect_near(at(part(whole, to, to), 0), {at(whole, to).q, all(0), all(0)});
}

TEST_F(RetimingTest, BackwardsItIsTheSamePathAndItsSpeedsAreOpposite) {
  const Trajectory whole = way(), back = reversed(whole);
  expect_no_jump_and_within_limits(back);
  for (double t = 0; t <= whole.duration_s(); t += 0.05) {
    JointState there = at(whole, whole.duration_s() - t);
    there.v = -there.v;
    expect_near(at(back, t), there);
  }
}

TEST_F(RetimingTest, ABrakedMotionComesToRestOnItsPathWithinLimitsWhereverItIsBraked) {
  SCOPED_TRACE("seed 11");
  for (int i = 0; i < 60; ++i) {
    const Trajectory whole = way();
    const double from = place(std::abs(uniform_(random_)), whole);
    const Retimed stop = brake(whole, from, limits_);
    expect_near(at(stop.trajectory, 0), at(whole, from));
    expect_no_jump_and_within_limits(stop.trajectory);
    EXPECT_TRUE(at_rest(at(stop.trajectory, stop.trajectory.duration_s())));
    expect_near(at(stop.trajectory, stop.trajectory.duration_s()),
                {at(whole, stop.place_s).q, all(0), all(0)});
    EXPECT_LE(stop.place_s, next_rest_s(whole, from) + 1e-9) << "it does not go on past a stop";
    for (double t = 0; t <= stop.trajectory.duration_s(); t += 0.03) {
      EXPECT_LT(off_path(whole, at(stop.trajectory, t).q), 1e-6);
    }
  }
}

/// The check of a trajectory accepts up to a thousandth more than a limit.
TEST_F(RetimingTest, ACruiseThatUsesALittleMoreThanALimitIsBrakedAndGoneOnWithAtOnce) {
  constexpr double kRise_s = 2, kCruise_s = 20;
  for (const double use : {1.0, 1.000002, 1.0005, 1.000999}) {
    const double v = use * limits_.max_velocity[0], rise = v * kRise_s / 2, cruise = v * kCruise_s;
    Trajectory whole{.goal_id = 7,
                     .dof = kJoints,
                     .start = kStart,
                     .knots = {0, kRise_s, kRise_s + kCruise_s, 2 * kRise_s + kCruise_s},
                     .pieces = {}};
    for (const auto& [from, to, lasts_s] :
         {std::tuple{Quintic::End{0, 0, 0}, Quintic::End{rise, v, 0}, kRise_s},
          std::tuple{Quintic::End{rise, v, 0}, Quintic::End{rise + cruise, v, 0}, kCruise_s},
          std::tuple{Quintic::End{rise + cruise, v, 0}, Quintic::End{2 * rise + cruise, 0, 0},
                     kRise_s}}) {
      whole.pieces.insert(whole.pieces.end(), kJoints, Quintic::between(from, to, lasts_s));
    }
    const Retimed stop = brake(whole, 5, limits_);
    EXPECT_LT(stop.trajectory.duration_s(), 1) << use;
    EXPECT_LT(stop.place_s, 5.5) << use;
    const Retimed on = speed_up(whole, 5, whole.duration_s(), limits_);
    EXPECT_LT(on.ramp_s, 1) << use;
    for (const Trajectory* driven : {&stop.trajectory, &on.trajectory}) {
      const LimitUse most = limit_use(*driven, limits_.max_velocity, limits_.max_acceleration);
      EXPECT_LE(std::max(most.velocity, most.acceleration), use + 2e-6);
    }
  }
}

TEST_F(RetimingTest, PlacesBeforeAndBehindTheMotionAreItsEnds) {
  const Trajectory whole = way();
  const double end = whole.duration_s();
  EXPECT_EQ(brake(whole, -5, limits_).place_s, 0);
  EXPECT_EQ(brake(whole, 1e9, limits_).place_s, end);
  EXPECT_EQ(speed_up(whole, -5, -4, limits_).place_s, 0);
  EXPECT_EQ(speed_up(whole, 1e9, 2e9, limits_).place_s, end);
  const Retimed before = speed_up(whole, -5, stop_s_, limits_);
  const Retimed from_start = speed_up(whole, 0, stop_s_, limits_);
  EXPECT_EQ(before.place_s, from_start.place_s);
  EXPECT_EQ(before.trajectory.duration_s(), from_start.trajectory.duration_s());
  const Retimed behind = speed_up(whole, stop_s_, 1e9, limits_);
  EXPECT_LE(behind.place_s, end);
  expect_near(at(behind.trajectory, behind.trajectory.duration_s()),
              {at(whole, end).q, all(0), all(0)});
}

TEST_F(RetimingTest, AMotionThatRestsStaysWhereItIs) {
  const Trajectory whole = way();
  const Retimed stop = brake(whole, stop_s_, limits_);
  EXPECT_EQ(stop.place_s, stop_s_);
  EXPECT_EQ(stop.trajectory.duration_s(), 0);
}

/// A stop that leaves the path would take as long: its slowest joint needs the speed's share of the
/// acceleration.
TEST_F(RetimingTest, ABrakeIsNotMuchLongerThanAStopThatLeavesThePath) {
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    const Trajectory whole = way();
    const double from = place(std::abs(uniform_(random_)), whole);
    const double free_s =
        stop_from(at(whole, from), limits_.max_velocity, limits_.max_acceleration, kStart, 0)
            .duration_s();
    worst = std::max(worst, brake(whole, from, limits_).trajectory.duration_s() - free_s);
  }
  EXPECT_LT(worst, 0.5) << "s longer";
}

TEST_F(RetimingTest, FromAnywhereOnThePathTheMotionGoesOnAsItWasPlanned) {
  SCOPED_TRACE("seed 11");
  int slower = 0;
  for (int i = 0; i < 60; ++i) {
    const Trajectory whole = way();
    const double from = place(std::abs(uniform_(random_)), whole);
    const double to = next_rest_s(whole, from);
    const Retimed on = speed_up(whole, from, to, limits_);
    expect_near(at(on.trajectory, 0), {at(whole, from).q, all(0), all(0)});
    expect_no_jump_and_within_limits(on.trajectory);
    expect_near(at(on.trajectory, on.trajectory.duration_s()), at(whole, to));
    const bool is_ramp = on.ramp_s < on.trajectory.duration_s();
    expect_near(at(on.trajectory, on.ramp_s), at(whole, on.place_s));
    slower += is_ramp ? 0 : 1;
  }
  EXPECT_LE(slower, 3) << "of 60; only where a stop is near";
}

TEST_F(RetimingTest, JustBeforeAStopTheRestOfTheWayIsGoneSlower) {
  for (const double before_s : {1e-4, 1e-3, 0.005}) {
    const Trajectory whole = way();
    const Retimed on = speed_up(whole, stop_s_ - before_s, stop_s_, limits_);
    EXPECT_EQ(on.ramp_s, on.trajectory.duration_s()) << "all of it is retimed";
    expect_no_jump_and_within_limits(on.trajectory);
    expect_near(at(on.trajectory, on.ramp_s), at(whole, stop_s_));
  }
}

TEST_F(RetimingTest, WhatLastsNoTimeLeavesNoPieceBeforeAMotion) {
  const Trajectory whole = way();
  const double from = place(0.4, whole);
  const Trajectory rest = part(whole, from, whole.duration_s());
  const Trajectory none = part(whole, from, from);
  ASSERT_EQ(none.duration_s(), 0);
  const Trajectory joined = followed_by(none, rest);
  EXPECT_EQ(joined.knots, rest.knots);
  EXPECT_EQ(joined.pieces.size(), rest.pieces.size());
  expect_no_jump_and_within_limits(joined);
}

TEST_F(RetimingTest, APartThatIsCutJustBesideAKnotBeginsAndEndsWhereItWasCut) {
  const Trajectory whole = way();
  for (const double beside_s : {-9e-7, -1e-9, 0.0, 1e-9, 9e-7}) {
    const double cut_s = whole.knots[1] + beside_s;
    expect_near(state_at(part(whole, cut_s, whole.duration_s()).view(), 0),
                state_at(whole.view(), cut_s));
    const Trajectory until = part(whole, 0, cut_s);
    EXPECT_EQ(until.duration_s(), cut_s);
    expect_near(state_at(until.view(), cut_s), state_at(whole.view(), cut_s));
  }
}

TEST_F(RetimingTest, AStopOfThePlannedMotionIsFound) {
  const Trajectory whole = way();
  EXPECT_NEAR(next_rest_s(whole, 0), stop_s_, 1e-12);
  EXPECT_NEAR(next_rest_s(whole, stop_s_), whole.duration_s(), 1e-12);
}

}  // namespace
}  // namespace armature
