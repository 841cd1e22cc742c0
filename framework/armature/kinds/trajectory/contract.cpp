// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/contract.hpp"

#include <algorithm>
#include <cmath>

namespace armature {

JointVector TrajectoryLaws::random_vector(double size) {
  JointVector v(kDof);
  for (double& x : v) x = size * normal_(random_);
  return v;
}

JointSegment TrajectoryLaws::curve_from(const JointVector& q, int n, double size) {
  const JointVector line = random_vector(size), bow = random_vector(0.5 * size);
  JointSegment segment;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    segment.s.push_back(s);
    segment.q.push_back(q + s * line + (n > 1 ? s * (1 - s) : 0) * bow);
  }
  return segment;
}

TrajectoryRequest TrajectoryLaws::request(double start_speed) {
  TrajectoryRequest request;
  request.goal_id = 7;
  request.start = Time{5'000'000'000};
  request.from = {random_vector(1), random_vector(start_speed), random_vector(start_speed)};
  request.max_velocity = JointVector::Constant(kDof, 1.5);
  request.max_acceleration = JointVector::Constant(kDof, 4);
  return request;
}

void TrajectoryLaws::expect_keeps_limits(const Trajectory& trajectory,
                                         const TrajectoryRequest& request) {
  const auto at_start = [](const JointVector& rate, const JointVector& limit) {
    return std::max(1.0, rate.cwiseAbs().cwiseQuotient(limit).maxCoeff());
  };
  const LimitUse use = limit_use(trajectory, request.max_velocity, request.max_acceleration);
  EXPECT_LE(use.velocity, at_start(request.from.v, request.max_velocity) + 1e-6);
  EXPECT_LE(use.acceleration, at_start(request.from.a, request.max_acceleration) + 1e-6);
  EXPECT_LE(jerk_use(trajectory, request.max_jerk), 1 + 1e-6);
}

void TrajectoryLaws::expect_joins_start_and_goal(const Trajectory& trajectory,
                                                 const TrajectoryRequest& request) {
  const JointState first = trajectory.at(request.start), last = trajectory.at(trajectory.end());
  EXPECT_LE((first.q - request.from.q).norm(), 1e-9);
  EXPECT_LE((first.v - request.from.v).norm(), 1e-9);
  EXPECT_LE((first.a - request.from.a).norm(), 1e-8);
  EXPECT_LE((last.q - request.segments.back().q.back()).norm(), 1e-9);
  EXPECT_LE(last.v.norm(), 1e-7);
  EXPECT_LE(last.a.norm(), 1e-6);
}

void TrajectoryLaws::expect_has_no_jump(const Trajectory& trajectory) {
  for (int k = 1; k < trajectory.piece_count(); ++k) {
    const double h = trajectory.knots[static_cast<std::size_t>(k)] -
                     trajectory.knots[static_cast<std::size_t>(k) - 1];
    for (int j = 0; j < trajectory.dof; ++j) {
      const auto piece = [&](int i) {
        return trajectory.pieces[static_cast<std::size_t>(i * trajectory.dof + j)];
      };
      EXPECT_NEAR(piece(k - 1).position(h), piece(k).position(0), 1e-9);
      EXPECT_NEAR(piece(k - 1).velocity(h), piece(k).velocity(0), 1e-7);
      EXPECT_NEAR(piece(k - 1).acceleration(h), piece(k).acceleration(0), 1e-5);
    }
  }
}

void TrajectoryLaws::expect_good(const Expected<Trajectory>& planned,
                                 const TrajectoryRequest& request) {
  ASSERT_TRUE(planned) << planned.error().text;
  EXPECT_EQ(planned->goal_id, request.goal_id);
  EXPECT_EQ(planned->start, request.start);
  expect_keeps_limits(*planned, request);
  expect_joins_start_and_goal(*planned, request);
  expect_has_no_jump(*planned);
}

TEST_P(TrajectoryLaws, FromRestItKeepsTheLimitsUsesThemAndHasNoJump) {
  SCOPED_TRACE("seed 11");
  for (int i = 0; i < 100; ++i) {
    TrajectoryRequest wanted = request(0);
    wanted.segments = {curve_from(wanted.from.q, 1, 1)};
    wanted.segments.push_back(curve_from(wanted.segments.back().q.back(), 2 + i % 20, 0.5));
    const auto planned = planner().plan(wanted);
    expect_good(planned, wanted);
    const LimitUse use = limit_use(*planned, wanted.max_velocity, wanted.max_acceleration);
    EXPECT_GE(std::max(use.velocity, use.acceleration), 1 - 1e-6);
  }
}

TEST_P(TrajectoryLaws, FromAMovingStartItLeavesWithoutAJumpWithinTheLimits) {
  SCOPED_TRACE("seed 11");
  for (int i = 0; i < 100; ++i) {
    TrajectoryRequest wanted = request(0.5);
    wanted.segments = {curve_from(wanted.from.q, 1 + i % 20, i % 3 == 0 ? 1e-3 : 0.7)};
    expect_good(planner().plan(wanted), wanted);
  }
}

TEST_P(TrajectoryLaws, KeepsAJerkLimitToo) {
  SCOPED_TRACE("seed 11");
  for (int i = 0; i < 100; ++i) {
    TrajectoryRequest wanted = request(i % 2 == 0 ? 0 : 0.2);
    wanted.max_jerk = JointVector::Constant(kDof, 5);
    wanted.segments = {curve_from(wanted.from.q, 1 + i % 10, 0.7)};
    const auto planned = planner().plan(wanted);
    expect_good(planned, wanted);
    if (i % 2 == 1) continue;
    const LimitUse use = limit_use(*planned, wanted.max_velocity, wanted.max_acceleration);
    const double jerk = jerk_use(*planned, wanted.max_jerk);
    EXPECT_GT(jerk, 0.1);
    EXPECT_GE(std::max({use.velocity, use.acceleration, jerk}), 1 - 1e-6);
  }
}

TEST_P(TrajectoryLaws, PlanningAgainAndAgainOnTheWayStillArrivesInTime) {
  SCOPED_TRACE("seed 11");
  for (int i = 0; i < 20; ++i) {
    TrajectoryRequest wanted = request(0.2);
    const JointVector goal = wanted.from.q + random_vector(0.7);
    double first_duration = 0;
    for (int step = 0; step < 200; ++step) {
      wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, goal}, true, {}}};
      const auto planned = planner().plan(wanted);
      ASSERT_TRUE(planned) << planned.error().text;
      if (step == 0) first_duration = planned->duration_s();
      if (planned->duration_s() < 0.1) break;
      EXPECT_LE(0.1 * step + planned->duration_s(), 1.25 * first_duration + 0.1);
      wanted.start = wanted.start + seconds(0.1);
      wanted.from = planned->at(wanted.start);
    }
    EXPECT_LE((wanted.from.q - goal).norm(), 0.02);
  }
}

TEST_P(TrajectoryLaws, PassesEveryWaypointOfACurve) {
  SCOPED_TRACE("seed 11");
  TrajectoryRequest wanted = request(0);
  wanted.segments = {curve_from(wanted.from.q, 12, 0.6)};
  const auto planned = planner().plan(wanted);
  ASSERT_TRUE(planned);
  for (const JointVector& q : wanted.segments.front().q) {
    double nearest = 1;
    for (const double knot : planned->knots) {
      nearest = std::min(nearest, (planned->at(planned->start + seconds(knot)).q - q).norm());
    }
    EXPECT_LE(nearest, 1e-7);
  }
}

TEST_P(TrajectoryLaws, AViaIsPassedWithoutStopping) {
  TrajectoryRequest wanted = request(0);
  wanted.segments = {curve_from(wanted.from.q, 1, 0.6)};
  wanted.segments.front().stop_at_end = false;
  const JointVector corner = wanted.segments.front().q.back();
  wanted.segments.push_back(curve_from(corner, 10, 0.6));
  const auto planned = planner().plan(wanted);
  expect_good(planned, wanted);
  for (const double knot : planned->knots) {
    const JointState state = planned->at(planned->start + seconds(knot));
    if ((state.q - corner).norm() < 1e-7) {
      EXPECT_GT(state.v.norm(), 0.05);
    }
  }
}

TEST_P(TrajectoryLaws, ASegmentsOwnDurationIsKeptExactlyOrRefusedWithTheNeededOne) {
  TrajectoryRequest wanted = request(0);
  wanted.from.q.setZero();
  JointSegment segment{{0, 1}, {wanted.from.q, JointVector::Constant(kDof, 0.5)}, true, 1.25};
  JointSegment back{{0, 1}, {segment.q[1], segment.q[0]}, true, 1.5};
  wanted.segments = {segment, back};
  const auto planned = planner().plan(wanted);
  if (!GetParam().offers_time_law) {
    EXPECT_FALSE(planned);
    return;
  }
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->duration_s(), 2.75);
  EXPECT_LE((planned->at(wanted.start + seconds(1.25)).q - segment.q[1]).norm(), 1e-9);
  wanted.max_velocity.setConstant(0.75);
  wanted.segments[0].duration_s = 3;
  wanted.segments[1].duration_s = 0.6;  // a mean speed of 0.83
  const auto refused = planner().plan(wanted);
  ASSERT_FALSE(refused);
  const std::string text = refused.error().text,
                    known = "segment 2 lasts 0.600 s, its limits need ";
  ASSERT_EQ(text.substr(0, known.size()), known);
  const double needed = std::stod(text.substr(known.size()));
  wanted.segments[1].duration_s = needed + 0.001;
  EXPECT_TRUE(planner().plan(wanted));
  wanted.segments[1].duration_s = needed - 0.001;
  EXPECT_FALSE(planner().plan(wanted));
}

TEST_P(TrajectoryLaws, GoingNowhereIsHolding) {
  TrajectoryRequest wanted = request(0);
  wanted.segments = {
      JointSegment{{0, 1}, {wanted.from.q, wanted.from.q}, true, {}},
      JointSegment{{0, 0.5, 1}, {wanted.from.q, wanted.from.q, wanted.from.q}, true, {}}};
  const auto planned = planner().plan(wanted);
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->at(planned->start + seconds(1)).q, wanted.from.q);
  EXPECT_LE(planned->duration_s(), 0.1);
}

TEST_P(TrajectoryLaws, AMovingStartThatShallGoNowhereComesBackToRest) {
  TrajectoryRequest wanted = request(0.4);
  wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, wanted.from.q}, true, {}}};
  expect_good(planner().plan(wanted), wanted);
}

TEST_P(TrajectoryLaws, ATinyMotionHasAFiniteTrajectory) {
  TrajectoryRequest wanted = request(0);
  JointVector next = wanted.from.q;
  next[0] += 1e-11;
  wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, next}, true, {}}};
  expect_good(planner().plan(wanted), wanted);
}

TEST_P(TrajectoryLaws, EqualRequestsGiveEqualBits) {
  TrajectoryRequest wanted = request(0.3);
  wanted.segments = {curve_from(wanted.from.q, 9, 0.6)};
  const auto a = planner().plan(wanted), b = planner().plan(wanted);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->knots, b->knots);
  for (std::size_t i = 0; i < a->pieces.size(); ++i) EXPECT_EQ(a->pieces[i].c, b->pieces[i].c);
}

TEST_P(TrajectoryLaws, ARequestThatContradictsItselfIsRefusedWithAReason) {
  const TrajectoryRequest good = [&] {
    TrajectoryRequest wanted = request(0);
    wanted.segments = {curve_from(wanted.from.q, 3, 0.5)};
    return wanted;
  }();
  const auto refusal = [&](auto change) {
    TrajectoryRequest bad = good;
    change(bad);
    const auto planned = planner().plan(bad);
    return planned ? "" : planned.error().text;
  };
  EXPECT_EQ(refusal([](auto& r) { r.segments.clear(); }), "there is no segment");
  EXPECT_EQ(refusal([](auto& r) { r.max_velocity[1] = 0; }),
            "the limits are not positive numbers, one per joint");
  EXPECT_EQ(refusal([](auto& r) { r.from.v[0] = NAN; }), "the start is not a joint state");
  EXPECT_EQ(refusal([](auto& r) { r.segments[0].q[1][0] = NAN; }),
            "segment 1 has a waypoint that is not a joint position");
  EXPECT_EQ(refusal([](auto& r) { r.segments[0].s[2] = 0; }),
            "segment 1 has waypoints whose s does not ascend");
  EXPECT_EQ(refusal([](auto& r) { r.segments[0].q.pop_back(); }),
            "segment 1 needs two or more waypoints and an s for each");
  EXPECT_EQ(refusal([](auto& r) { r.from.q[0] += 0.5; }),
            "segment 1 starts 0.5 away from where it should");
  EXPECT_EQ(refusal([](auto& r) {
              r.segments[0].stop_at_end = false;
              r.segments[0].duration_s = 1;
            }),
            "segment 1 has its own duration but does not run from stop to stop");
}
}  // namespace armature
