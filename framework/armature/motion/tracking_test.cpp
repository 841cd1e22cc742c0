// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <variant>

#include "armature/motion/gantry_stages_test.hpp"

namespace armature {
namespace {

using test::Gantry;
using test::goal_at;
using test::rest_at;

const TrackingOptions kHorizon{.shortest_horizon_s = 0.1};

/// A way as it was made, or the failure.
struct Tracked {
  ShortTrajectory way;
  TrackingFailure failure;

  explicit operator bool() const { return failure.stage.empty(); }
  JointState at(Time time) const { return way.view().at(time); }
  double horizon_s() const { return way.knots[1]; }
};

Tracked track(Tracker tracker, const MotionGoal& goal, const JointState& from, Time start) {
  Tracked tracked;
  tracked.failure = tracker.begin(goal, from, start, tracked.way);
  return tracked;
}

/// Counts how often it is asked.
class CountingIk : public IkSolver {
 public:
  explicit CountingIk(const IkSolver& ik) : ik_{ik} {}
  IkStatus solve(const IkGoal& goal, const JointVector& near, IkBranches& out,
                 IkState& state) const override {
    ++asked;
    return ik_.solve(goal, near, out, state);
  }
  mutable int asked = 0;

 private:
  const IkSolver& ik_;
};

TEST(Tracking, MeetsATargetThatMovesWithItsVelocity) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 0.02, 0, 0);
  goal.mode = MotionMode::tracking;
  goal.velocity = {0.1, 0, 0};
  auto plan = track(gantry.tracker(kHorizon), goal, rest_at(0, 0, 0), Time{0});
  ASSERT_TRUE(plan) << plan.failure.reason.view();
  const double horizon = plan.horizon_s();
  const JointState meet = plan.at(Time{} + seconds(horizon));
  EXPECT_NEAR(meet.q[2], 0.02 + 0.1 * horizon, 1e-9);
  EXPECT_NEAR(meet.v[2], 0.1, 1e-6);
  EXPECT_NEAR(plan.at(plan.way.view().end()).v.norm(), 0, 1e-9);
}

TEST(Tracking, TakesLongerInsteadOfBreakingLimits) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1.2, -1, 0.4);
  auto plan = track(gantry.tracker(kHorizon), goal, rest_at(0, 0, 0), Time{0});
  ASSERT_TRUE(plan) << plan.failure.reason.view();
  const LimitUse use = limit_use(to_trajectory(plan.way.view()), gantry.limits.max_velocity,
                                 gantry.limits.max_acceleration);
  EXPECT_LE(use.velocity, 1.001);
  EXPECT_LE(use.acceleration, 1.001);
  EXPECT_GT(plan.horizon_s(), 1.2);
}

TEST(Tracking, OnTheWayOneAttemptACallFindsWhatASearchFromTheShortestOnFinds) {
  const Gantry gantry;
  const CountingIk ik{gantry.ik};
  Tracker tracker{gantry.model, gantry.limits, ik, kHorizon};
  ShortTrajectory current, next;
  JointState from = rest_at(0, 0, 0);
  int failures = 0, longer = 0;  // than it need be: one growth, until the next call
  for (int k = 0; k < 3000; ++k) {
    const Time now = Time{} + k * seconds(0.001);
    MotionGoal goal = goal_at(static_cast<std::uint64_t>(k + 1), 1.2 + 2e-4 * k, -1, 0.4);
    goal.velocity = {0.2, 0, 0};
    const Tracked anew = track(gantry.tracker(kHorizon), goal, from, now);
    ASSERT_TRUE(anew) << anew.failure.reason.view();
    const int asked_before = ik.asked;
    const TrackingFailure failure =
        k == 0 ? tracker.begin(goal, from, now, next) : tracker.follow(goal, from, now, next);
    ASSERT_LE(ik.asked - asked_before, k == 0 ? 3 * Tracker::kMaxAttempts : 6) << "at step " << k;
    failures = failure.stage.empty() ? 0 : failures + 1;
    ASSERT_LE(failures, 1) << "at step " << k << ": " << failure.reason.view();
    if (failures == 0) {
      current = next;
      longer += current.knots[1] > anew.horizon_s();
      ASSERT_GE(current.knots[1], anew.horizon_s()) << "at step " << k;
      ASSERT_LT(current.knots[1], 1.26 * anew.horizon_s()) << "at step " << k;
    }
    from = current.view().at(now + seconds(0.001));
  }
  EXPECT_LE(longer, 10);
}

TEST(Tracking, FollowsACircleWithoutAJumpAndWithinLimits) {
  const Gantry gantry;
  ShortTrajectory current = short_hold_at(Eigen::Vector3d{0, 0, 0.3}, Time{0}, 0);
  JointState before = current.view().at(Time{0});
  double worst_lag_m = 0;
  for (int k = 1; k < 6000; ++k) {
    const Time now = Time{} + k * seconds(0.001);
    const double t = 0.001 * k;
    const Eigen::Vector3d target{0.3 * std::cos(t), 0.3 * std::sin(t), 0};
    if (k % 33 == 0) {
      MotionGoal goal = goal_at(static_cast<std::uint64_t>(k), target.x(), target.y(), 0);
      goal.velocity = {-0.3 * std::sin(t), 0.3 * std::cos(t), 0};
      auto plan = track(gantry.tracker(kHorizon), goal, current.view().at(now), now);
      ASSERT_TRUE(plan) << plan.failure.reason.view();
      current = plan.way;
    }
    const JointState state = current.view().at(now);
    ASSERT_TRUE(test::no_jump(before, state, 0.001)) << "at step " << k;
    ASSERT_LE(state.v.cwiseAbs().maxCoeff(), 1.001);
    ASSERT_LE(state.a.cwiseAbs().maxCoeff(), 2.501);
    if (k > 2000) {
      worst_lag_m = std::max(worst_lag_m,
                             (Eigen::Vector3d{state.q[2], state.q[1], state.q[0]} - target).norm());
    }
    before = state;
  }
  EXPECT_LT(worst_lag_m, 0.003);
}

/// The one joint of a turntable points where the goal does.
class TurntableIk : public IkSolver {
 public:
  IkStatus solve(const IkGoal& goal, const JointVector&, IkBranches& out, IkState&) const override {
    const Eigen::Vector3d& u = std::get<Direction>(goal.pose.orientation).unit;
    out.clear();
    IkBranch& branch = out.add();
    branch.q = JointVector::Constant(1, std::atan2(u.y(), u.x()));
    branch.within_limits = true;
    return {};
  }
};

TEST(Tracking, MeetsATargetThatTurnsWithItsAngularVelocity) {
  Joint joint;
  joint.name = "turn";
  joint.lower = -3;
  joint.upper = 3;
  joint.max_velocity = 2;
  joint.max_acceleration = 20;
  const RobotModel turntable{{"turntable",
                              RobotModel::Convention::standard,
                              {joint},
                              {{.name = "tool", .parent_joint = 0}},
                              FrameId{0},
                              Eigen::Vector3d::UnitX(),
                              std::nullopt}};
  const TurntableIk ik;
  const Tracker tracker{
      turntable, {turntable.max_velocity(), turntable.max_acceleration()}, ik, kHorizon};
  MotionGoal goal = goal_at(1, 0, 0, 0);
  goal.mode = MotionMode::tracking;
  goal.pose.orientation = Direction{{1, 0, 0}};
  goal.angular_velocity = {0, 0, 0.4};
  const JointVector zero = JointVector::Zero(1);
  auto plan = track(tracker, goal, {zero, zero, zero}, Time{0});
  ASSERT_TRUE(plan) << plan.failure.reason.view();
  const double horizon = plan.horizon_s();
  const JointState meet = plan.at(Time{} + seconds(horizon));
  EXPECT_NEAR(meet.q[0], 0.4 * horizon, 1e-9);
  EXPECT_NEAR(meet.v[0], 0.4, 1e-6);
}

TEST(Tracking, TakesLongerInsteadOfBreakingTheJerkLimit) {
  const Gantry gantry;
  const MotionGoal goal = goal_at(1, 0.1, -0.05, 0.02);
  const JointState from{.q = Eigen::Vector3d{0, 0, 0},
                        .v = Eigen::Vector3d{0.1, 0, -0.2},
                        .a = Eigen::Vector3d{0, 0.5, 1}};
  const auto highest_jerk = [&](const JointVector& limit) {
    const auto plan =
        track(gantry.tracker({.shortest_horizon_s = 0.05, .max_jerk = limit}), goal, from, Time{0});
    EXPECT_TRUE(plan) << plan.failure.reason.view();
    double highest = 0;
    for (double t = 0; t < plan.horizon_s(); t += 1e-4) {
      highest = std::max(
          highest,
          to_trajectory(plan.way.view()).jerk_at(Time{} + seconds(t)).cwiseAbs().maxCoeff());
    }
    return highest;
  };
  EXPECT_GT(highest_jerk({}), 20);
  EXPECT_LE(highest_jerk(JointVector::Constant(3, 20)), 20 * (1 + 1e-9));
  EXPECT_GT(highest_jerk(JointVector::Constant(3, 20)), 5) << "it need not take much longer";
}

TEST(Tracking, AJerkLimitThatNoHorizonKeepsIsToldWithItsNumber) {
  const Gantry gantry;
  const auto plan =
      track(gantry.tracker({.shortest_horizon_s = 0.1, .max_jerk = JointVector::Constant(3, 1e-6)}),
            goal_at(1, 0.1, 0, 0), rest_at(0, 0, 0), Time{0});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.failure.stage, "trajectory");
  EXPECT_EQ(plan.failure.reason.view().substr(0, 59),
            "tracking within limits: joint x would need a jerk of 0.0012");
}

TEST(Tracking, ATargetThatIsTooFastIsFollowedBehindAndMetWhenItWaits) {
  const Gantry gantry;
  const TrackingOptions slow{.shortest_horizon_s = 0.01, .max_tool_speed = 0.05};
  ShortTrajectory current = short_hold_at(Eigen::Vector3d{0, 0, 0}, Time{0}, 0);
  double fastest = 0, farthest_behind = 0;
  int refused = 0;
  for (int k = 1; k < 4000; ++k) {
    const Time now = Time{} + k * seconds(0.001);
    const double t = std::min(0.001 * k, 1.0);  // it goes 0.08 m in the plane, then stays
    MotionGoal goal = goal_at(static_cast<std::uint64_t>(k), 0.064 * t, 0.048 * t, 0);
    if (k <= 1000) goal.velocity = {0.064, 0.048, 0};
    const auto plan = track(gantry.tracker(slow), goal, current.view().at(now), now);
    if (plan) current = plan.way;
    refused += !plan;
    const JointState state = current.view().at(now);
    fastest = std::max(fastest, state.v.norm());
    const Eigen::Vector3d tool{state.q[2], state.q[1], state.q[0]};
    farthest_behind = std::max(farthest_behind, (tool - goal.pose.position).norm());
  }
  EXPECT_LE(fastest, 0.05 * (1 + 1e-6));
  EXPECT_GT(fastest, 0.049) << "it need not be slower";
  EXPECT_GT(farthest_behind, 0.02);
  EXPECT_EQ(refused, 0);
  const JointState end = current.view().at(Time{} + seconds(4.0));
  EXPECT_LT((end.q - Eigen::Vector3d{0, 0.048, 0.064}).norm(), 1e-6);
}

TEST(Tracking, AToolThatIsTooFastAlreadyDoesNotBecomeFaster) {
  const Gantry gantry;
  JointState from = rest_at(0, 0, 0);
  from.v = Eigen::Vector3d{0, 0, 0.2};
  const auto plan = track(gantry.tracker({.shortest_horizon_s = 0.01, .max_tool_speed = 0.05}),
                          goal_at(1, 0.1, 0, 0), from, Time{0});
  ASSERT_TRUE(plan) << plan.failure.reason.view();
  for (double t = 0; t < plan.horizon_s(); t += 1e-3) {
    EXPECT_LE(plan.at(Time{} + seconds(t)).v.norm(), 0.2 * (1 + 1e-6)) << t;
  }
}

TEST(Tracking, RefusesATargetOutOfReach) {
  const Gantry gantry;
  auto plan = track(gantry.tracker(kHorizon), goal_at(1, 3, 0, 0), rest_at(0, 0, 0), Time{0});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.failure.stage, "ik");
}

TEST(Tracking, RefusesABranchThatTakesTheToolPastItsTarget) {
  Gantry gantry;
  gantry.ik.beside_m = 0.02;
  const auto plan =
      track(gantry.tracker(kHorizon), goal_at(1, 0.5, 0, 0), rest_at(0, 0, 0), Time{0});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.failure.stage, "ik");
  EXPECT_EQ(plan.failure.reason.view(),
            "the goal: the branch 'only' misses it by 20.0000 mm and 0.0000 degrees");
}

TEST(Tracking, ATargetThatTheLimitsCannotMeetBeforeItLeavesTheReachFailsByTheLimits) {
  const Gantry gantry;
  MotionGoal goal = goal_at(1, 1.9, 0, 0);  // 2 m is the end of the reach
  goal.velocity = {0.5, 0, 0};
  const auto plan = track(gantry.tracker(kHorizon), goal, rest_at(0, 0, 0), Time{0});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.failure.stage, "trajectory");
  EXPECT_EQ(plan.failure.reason.view().substr(0, 24), "tracking within limits: ");
  EXPECT_NE(plan.failure.reason.view().find(" s ahead the goal: out_of_reach"), std::string::npos)
      << plan.failure.reason.view();
}

/// Calls a tracker, and asserts that it did no more work than it says.
class BoundedTracker {
 public:
  explicit BoundedTracker(const Gantry& gantry, const TrackingOptions& options = kHorizon)
      : ik_{gantry.ik}, tracker_{gantry.model, gantry.limits, ik_, options} {}

  Tracked begin(const MotionGoal& goal, const JointState& from, Time start) {
    return bounded(&Tracker::begin, Tracker::kMaxAttempts, goal, from, start);
  }
  Tracked follow(const MotionGoal& goal, const JointState& from, Time start) {
    return bounded(&Tracker::follow, 1, goal, from, start);
  }
  int attempts() const { return tracker_.attempts(); }  // of the last call

 private:
  Tracked bounded(decltype(&Tracker::begin) way, int most, const MotionGoal& goal,
                  const JointState& from, Time start) {
    Tracked tracked;
    ik_.asked = 0;
    tracked.failure = (tracker_.*way)(goal, from, start, tracked.way);
    EXPECT_LE(tracker_.attempts(), most);
    EXPECT_LE(ik_.asked, 3 * tracker_.attempts() + 3);
    return tracked;
  }

  CountingIk ik_;
  Tracker tracker_;
};

TEST(Tracking, ATargetThatNoHorizonMeetsCostsFewAttempts) {
  const Gantry gantry;
  const auto attempts = [&](const MotionGoal& goal, const TrackingOptions& options) {
    BoundedTracker tracker{gantry, options};
    EXPECT_EQ(tracker.begin(goal, rest_at(0, 0, 0), Time{0}).failure.stage, "trajectory");
    return tracker.attempts();
  };
  MotionGoal leaves = goal_at(1, 1.9, 0, 0);  // 2 m is the end of the reach
  leaves.velocity = {0.5, 0, 0};
  EXPECT_LE(attempts(leaves, kHorizon), 8);
  const MotionGoal stays = goal_at(1, 1, 0, 0);
  // The first attempt tells that the longest horizon is too short.
  EXPECT_EQ(
      attempts(stays, {.shortest_horizon_s = 0.1, .max_jerk = JointVector::Constant(3, 1e-6)}), 2);
  EXPECT_LE(attempts(stays, {.shortest_horizon_s = 0.1, .max_tool_speed = 1e-3}), 3);
}

TEST(Tracking, ATargetThatIsTooFastIsFollowedWithOneAttemptACall) {
  const Gantry gantry;
  BoundedTracker tracker{gantry, {.shortest_horizon_s = 0.01, .max_tool_speed = 0.05}};
  ShortTrajectory current = short_hold_at(Eigen::Vector3d{0, 0, 0}, Time{0}, 0);
  constexpr int kSteps = 10'000;
  for (int k = 1; k <= kSteps; ++k) {
    const Time now = Time{} + k * seconds(0.001);
    const double t = 2.5e-3 * k;  // [rad] on a circle of 4 cm: 0.1 m/s
    MotionGoal goal =
        goal_at(static_cast<std::uint64_t>(k), 0.04 * std::sin(t), 0.04 * (1 - std::cos(t)), 0);
    goal.velocity = 0.1 * Eigen::Vector3d{std::cos(t), std::sin(t), 0};
    const JointState from = current.view().at(now);
    const Tracked next =
        at_rest(from) ? tracker.begin(goal, from, now) : tracker.follow(goal, from, now);
    if (next) current = next.way;
    ASSERT_LE(current.view().at(now).v.norm(), 0.05 * (1 + 1e-6)) << "at step " << k;
    const JointVector q = current.view().at(now).q;
    ASSERT_LE((Eigen::Vector3d{q[2], q[1], q[0]} - Eigen::Vector3d{0, 0.04, 0}).norm(), 0.09);
  }
}

/// The shortest horizon that one attempt with each of them finds; 0: none.
double shortest_of_all(const Gantry& gantry, TrackingOptions options, const MotionGoal& goal) {
  for (; options.shortest_horizon_s <= 20; options.shortest_horizon_s *= 1.25) {
    const Tracked one = track(gantry.tracker(options), goal, rest_at(0, 0, 0), Time{0});
    if (one && one.horizon_s() < 1.1 * options.shortest_horizon_s) return one.horizon_s();
  }
  return 0;
}

TEST(Tracking, FromRestFindsAHorizonWhereThereIsOneAndNearlyAlwaysTheShortest) {
  const Gantry gantry;
  const TrackingOptions options{
      .shortest_horizon_s = 0.01, .max_jerk = JointVector::Constant(3, 50), .max_tool_speed = 0.3};
  std::mt19937 random{1};
  std::uniform_real_distribution<double> one{-1, 1};
  const auto direction = [&] { return Eigen::Vector3d{one(random), one(random), one(random)}; };
  constexpr int kTargets = 2000;
  int longer = 0;
  for (int k = 0; k < kTargets; ++k) {
    const Eigen::Vector3d place = std::pow(10, 1.5 * one(random) - 1.5) * direction();
    MotionGoal goal = goal_at(1, place.x(), place.y(), place.z());
    goal.velocity = 0.06 * (k % 4) * direction();  // up to 0.31 m/s
    BoundedTracker tracker{gantry, options};
    const Tracked found = tracker.begin(goal, rest_at(0, 0, 0), Time{0});
    const double shortest = shortest_of_all(gantry, options, goal);
    ASSERT_EQ(static_cast<bool>(found), shortest > 0) << found.failure.reason.view();
    longer += found && found.horizon_s() > 1.001 * shortest;
  }
  EXPECT_LE(longer, kTargets / 100);
}

TEST(Tracking, TheToolsSpeedIsKeptBetweenThePlacesWhereItIsLookedAt) {
  const Gantry gantry;
  const TrackingOptions options{.shortest_horizon_s = 0.05, .max_tool_speed = 0.3};
  std::mt19937 random{1};
  std::uniform_real_distribution<double> one{-1, 1};
  const auto vector = [&](double size) {
    return Eigen::Vector3d{size * Eigen::Vector3d{one(random), one(random), one(random)}};
  };
  int found = 0;
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Vector3d place = vector(0.3);
    MotionGoal goal = goal_at(1, place.x(), place.y(), place.z());
    goal.velocity = vector(0.15);
    const JointState from{.q = vector(0.1), .v = vector(0.15), .a = vector(0.5)};
    const Tracked one_way = track(gantry.tracker(options), goal, from, Time{0});
    found += static_cast<bool>(one_way);
    for (double t = 0; one_way && t < one_way.horizon_s(); t += 1e-3) {
      ASSERT_LE(one_way.at(Time{} + seconds(t)).v.norm(), 0.3 * 1.001) << k << " after " << t;
    }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace armature
