// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "armature/kinds/trajectory/random_requests.hpp"
#include "armature/kinds/trajectory/sound_trajectory.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature {
namespace {

constexpr auto kSeed = RandomRequests::kSeed;
constexpr int kDof = RandomRequests::kDof;

void asks_round(LawCheck& check, int round) {
  check.asks(fmt::format("seed {}, round {}", kSeed, round));
}

void from_rest(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  for (int i = 0; i < 100; ++i) {
    asks_round(check, i);
    TrajectoryRequest wanted = random.request(0);
    wanted.segments = {random.curve_from(wanted.from.q, 1, 1)};
    wanted.segments.push_back(random.curve_from(wanted.segments.back().q.back(), 2 + i % 20, 0.5));
    const auto planned = subject.planner->plan(wanted);
    if (!check_sound(planned, wanted, check)) return;
    const LimitUse use = limit_use(*planned, wanted.max_velocity, wanted.max_acceleration);
    check.that(std::max(use.velocity, use.acceleration) >= 1 - 1e-6,
               "velocity or acceleration reaches its limit");
  }
}

void from_motion(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  for (int i = 0; i < 100; ++i) {
    asks_round(check, i);
    TrajectoryRequest wanted = random.request(0.5);
    wanted.segments = {random.curve_from(wanted.from.q, 1 + i % 20, i % 3 == 0 ? 1e-3 : 0.7)};
    check_sound(subject.planner->plan(wanted), wanted, check);
  }
}

void keeps_jerk(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  for (int i = 0; i < 100; ++i) {
    asks_round(check, i);
    TrajectoryRequest wanted = random.request(i % 2 == 0 ? 0 : 0.2);
    wanted.max_jerk = JointVector::Constant(kDof, 5);
    wanted.segments = {random.curve_from(wanted.from.q, 1 + i % 10, 0.7)};
    const auto planned = subject.planner->plan(wanted);
    if (!check_sound(planned, wanted, check)) return;
    if (i % 2 == 1) continue;
    const LimitUse use = limit_use(*planned, wanted.max_velocity, wanted.max_acceleration);
    const double jerk = jerk_use(*planned, wanted.max_jerk);
    check.that(jerk > 0.1, "a tenth of the jerk's limit is used");
    check.that(std::max({use.velocity, use.acceleration, jerk}) >= 1 - 1e-6,
               "velocity, acceleration or jerk reaches its limit");
  }
}

void planned_again(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  for (int i = 0; i < 20; ++i) {
    asks_round(check, i);
    TrajectoryRequest wanted = random.request(0.2);
    const JointVector goal = wanted.from.q + random.vector(0.7);
    double first_duration = 0;
    for (int step = 0; step < 200; ++step) {
      wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, goal}, true, {}}};
      const auto planned = subject.planner->plan(wanted);
      if (!check.answered(planned, "a new plan on the way")) return;
      if (step == 0) first_duration = planned->duration_s();
      if (planned->duration_s() < 0.1) break;
      check.at_most(0.1 * step + planned->duration_s(), 1.25 * first_duration + 0.1,
                    "the time of arrival [s]");
      wanted.start = wanted.start + seconds(0.1);
      wanted.from = planned->at(wanted.start);
    }
    check.at_most((wanted.from.q - goal).norm(), 0.02, "what is left of the way [rad or m]");
  }
}

void passes_waypoints(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  TrajectoryRequest wanted = random.request(0);
  wanted.segments = {random.curve_from(wanted.from.q, 12, 0.6)};
  const auto planned = subject.planner->plan(wanted);
  if (!check.answered(planned, "a curve through 13 waypoints")) return;
  for (const JointVector& q : wanted.segments.front().q) {
    double nearest = 1;
    for (const double knot : planned->knots) {
      nearest = std::min(nearest, (planned->at(planned->start + seconds(knot)).q - q).norm());
    }
    check.at_most(nearest, 1e-7, "from a waypoint to the nearest knot [rad or m]");
  }
}

void passes_vias(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  TrajectoryRequest wanted = random.request(0);
  wanted.segments = {random.curve_from(wanted.from.q, 1, 0.6)};
  wanted.segments.front().stop_at_end = false;
  const JointVector corner = wanted.segments.front().q.back();
  wanted.segments.push_back(random.curve_from(corner, 10, 0.6));
  const auto planned = subject.planner->plan(wanted);
  if (!check_sound(planned, wanted, check)) return;
  for (const double knot : planned->knots) {
    const JointState state = planned->at(planned->start + seconds(knot));
    if ((state.q - corner).norm() < 1e-7) {
      check.that(state.v.norm() > 0.05, "a via is passed at more than 0.05 rad/s");
    }
  }
}

/// Two segments there and back, 1.25 s and 1.5 s long.
TrajectoryRequest with_durations(RandomRequests& random) {
  TrajectoryRequest wanted = random.request(0);
  wanted.from.q.setZero();
  const JointSegment there{{0, 1}, {wanted.from.q, JointVector::Constant(kDof, 0.5)}, true, 1.25};
  const JointSegment back{{0, 1}, {there.q[1], there.q[0]}, true, 1.5};
  wanted.segments = {there, back};
  return wanted;
}

void keeps_durations(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  TrajectoryRequest wanted = with_durations(random);
  const auto planned = subject.planner->plan(wanted);
  if (!subject.provides_time_law) {
    check.refused(planned, "a duration of a segment's own, by a plugin without 'time_law'");
    return;
  }
  if (!check.answered(planned, "durations of 1.25 s and 1.5 s")) return;
  check.equal(planned->duration_s(), 2.75, "how long it lasts [s]");
  check.at_most((planned->at(wanted.start + seconds(1.25)).q - wanted.segments[0].q[1]).norm(),
                1e-9, "position beside the end of the first segment [rad or m]");
  wanted.max_velocity.setConstant(0.75);
  wanted.segments[0].duration_s = 3;
  wanted.segments[1].duration_s = 0.6;  // a mean speed of 0.83
  const auto refused = subject.planner->plan(wanted);
  if (!check.refused(refused, "a duration that is too short for the limits")) return;
  const std::string text = refused.error().text,
                    known = "segment 2 lasts 0.600 s, its limits need ";
  if (!check.equal(text.substr(0, known.size()), known, "the reason's beginning")) return;
  const double needed = std::stod(text.substr(known.size()));
  wanted.segments[1].duration_s = needed + 0.001;
  check.answered(subject.planner->plan(wanted), "1 ms more than the duration that is needed");
  wanted.segments[1].duration_s = needed - 0.001;
  check.refused(subject.planner->plan(wanted), "1 ms less than the duration that is needed");
}

void holds(const TrajectorySubject& subject, LawCheck& check) {
  TrajectoryRequest wanted = RandomRequests{}.request(0);
  wanted.segments = {
      JointSegment{{0, 1}, {wanted.from.q, wanted.from.q}, true, {}},
      JointSegment{{0, 0.5, 1}, {wanted.from.q, wanted.from.q, wanted.from.q}, true, {}}};
  const auto planned = subject.planner->plan(wanted);
  if (!check.answered(planned, "a way that goes nowhere")) return;
  check.that(planned->at(planned->start + seconds(1)).q == wanted.from.q,
             "a second later it is where it was");
  check.at_most(planned->duration_s(), 0.1, "how long it lasts [s]");
}

void comes_to_rest(const TrajectorySubject& subject, LawCheck& check) {
  TrajectoryRequest wanted = RandomRequests{}.request(0.4);
  wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, wanted.from.q}, true, {}}};
  check_sound(subject.planner->plan(wanted), wanted, check);
}

void tiny_motion(const TrajectorySubject& subject, LawCheck& check) {
  TrajectoryRequest wanted = RandomRequests{}.request(0);
  JointVector next = wanted.from.q;
  next[0] += 1e-11;
  wanted.segments = {JointSegment{{0, 1}, {wanted.from.q, next}, true, {}}};
  check_sound(subject.planner->plan(wanted), wanted, check);
}

void same_trajectory_bits(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  TrajectoryRequest wanted = random.request(0.3);
  wanted.segments = {random.curve_from(wanted.from.q, 9, 0.6)};
  const auto a = subject.planner->plan(wanted), b = subject.planner->plan(wanted);
  if (!check.answered(a, "a request") || !check.answered(b, "the same request")) return;
  check.that(a->knots == b->knots, "equal requests give the same knots");
  if (!check.equal(a->pieces.size(), b->pieces.size(), "the number of pieces")) return;
  for (std::size_t i = 0; i < a->pieces.size(); ++i) {
    check.that(a->pieces[i].c == b->pieces[i].c, "equal requests give the same coefficients");
  }
}

void far_numbers(const TrajectorySubject& subject, LawCheck& check) {
  constexpr std::array kFar{1e-320,
                            1e-300,
                            1e-30,
                            1e-9,
                            1e-5,
                            1e5,
                            1e14,
                            1e20,
                            1e300,
                            1e308,
                            std::numeric_limits<double>::infinity()};
  RandomRequests random;
  for (const int parts : {1, 3}) {
    TrajectoryRequest good = random.request(0);
    good.segments = {random.curve_from(good.from.q, parts, 0.5)};
    const auto asked = [&](const std::string& what, double number, auto change) {
      TrajectoryRequest wanted = good;
      change(wanted, number);
      check.asks(fmt::format("{} {}, {} parts, seed {}", what, number, parts, kSeed));
      const auto planned = subject.planner->plan(wanted);
      if (!planned) {
        check.refused(planned, what);
        return;
      }
      check.at_most(planned->duration_s(), 1.1e6, "how long it lasts [s]");
      check_sound(planned, wanted, check);
    };
    for (const double number : kFar) {
      asked("velocities of", number, [](auto& r, double x) { r.max_velocity.setConstant(x); });
      asked("one velocity of", number, [](auto& r, double x) { r.max_velocity[0] = x; });
      asked("accelerations of", number,
            [](auto& r, double x) { r.max_acceleration.setConstant(x); });
      asked("jerks of", number,
            [](auto& r, double x) { r.max_jerk = JointVector::Constant(kDof, x); });
      asked("a duration of", number, [](auto& r, double x) { r.segments[0].duration_s = x; });
      asked("velocities and accelerations of", number, [](auto& r, double x) {
        r.max_velocity.setConstant(x);
        r.max_acceleration.setConstant(x);
      });
    }
  }
}

void refuses_contradictions(const TrajectorySubject& subject, LawCheck& check) {
  RandomRequests random;
  TrajectoryRequest good = random.request(0);
  good.segments = {random.curve_from(good.from.q, 3, 0.5)};
  const auto refused = [&](const std::string& reason, auto change) {
    TrajectoryRequest bad = good;
    change(bad);
    check.refused_with(subject.planner->plan(bad), reason);
  };
  refused("there is no segment", [](auto& r) { r.segments.clear(); });
  refused("the limits are not positive numbers, one per joint",
          [](auto& r) { r.max_velocity[1] = 0; });
  refused("the start is not a joint state", [](auto& r) { r.from.v[0] = NAN; });
  refused("segment 1 has a waypoint that is not a joint position",
          [](auto& r) { r.segments[0].q[1][0] = NAN; });
  refused("segment 1 has waypoints whose s does not ascend",
          [](auto& r) { r.segments[0].s[2] = 0; });
  refused("segment 1 needs two or more waypoints and an s for each",
          [](auto& r) { r.segments[0].q.pop_back(); });
  refused("segment 1 starts 0.5 away from where it should", [](auto& r) { r.from.q[0] += 0.5; });
  refused("segment 1 has its own duration but does not run from stop to stop", [](auto& r) {
    r.segments[0].stop_at_end = false;
    r.segments[0].duration_s = 1;
  });
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<TrajectorySubject>{#Name, says, &function},
std::span<const Law<TrajectorySubject>> trajectory_laws() {
  static constexpr std::array kLaws{ARMATURE_TRAJECTORY_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
