// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "armature/kinds/trajectory/legs.hpp"

namespace armature {
namespace {

constexpr double kShortestLeg_s = 0.02;
constexpr double kAtRest = 1e-9;    // [rad/s], [rad/s2] or the like
constexpr double kRounding = 1e-9;  // of a limit
// A moving start is tried with longer and longer durations, from this part of what the leg needs
// from rest or the velocity needs to vanish; 1.25^39 is 6000 times longer.
constexpr double kFirstTry = 0.3, kGrowth = 1.25;
constexpr int kMostTries = 40, kRefinements = 6;

/// The times of all waypoints, and between them as many more as it takes to have no gap longer than
/// if they were even: where the law is slow, waypoints even in s lie far apart in time.
std::vector<double> knots_of(const JointCurve& curve, const TimeLaw& law) {
  const double even = law.duration_s() / static_cast<double>(curve.s().size() - 1);
  std::vector<double> knots{0};
  for (std::size_t i = 1; i < curve.s().size(); ++i) {
    const double before = knots.back(), behind = law.time_at(curve.s()[i]);
    const int parts = static_cast<int>(std::ceil((behind - before) / even - kRounding));
    for (int k = 1; k < parts; ++k) knots.push_back(before + (behind - before) * k / parts);
    knots.push_back(behind);
  }
  return knots;
}

/// One leg on its own clock, and how it is allowed to use the limits.
class LegTimer {
 public:
  LegTimer(const TrajectoryRequest& request, const Leg& leg, PiecesAlong pieces_along)
      : request_{request}, leg_{leg}, pieces_along_{pieces_along} {}

  Expected<Trajectory> from_rest() const {
    const Trajectory unit = along(TimeLaw{1});
    const double needed = needed_factor(unit);
    if (!leg_.duration_s)
      return stretched(unit, std::max(needed * (1 + kRounding), kShortestLeg_s));
    if (needed > *leg_.duration_s * (1 + kRounding)) return too_short(needed);
    return along(TimeLaw{*leg_.duration_s});
  }

  Expected<Trajectory> from_moving() const {
    if (leg_.duration_s) {
      Trajectory fixed = from_moving_in(*leg_.duration_s);
      if (within_limits(fixed)) return fixed;
      const auto shortest = shortest_from_moving();
      return shortest ? too_short(shortest->duration_s()) : shortest;
    }
    return shortest_from_moving();
  }

 private:
  Trajectory along(const TimeLaw& law) const {
    Trajectory trajectory{.goal_id = request_.goal_id,
                          .dof = leg_.curve.dof(),
                          .start = request_.start,
                          .knots = {},
                          .pieces = {}};
    trajectory.knots = knots_of(leg_.curve, law);
    trajectory.pieces = pieces_along_(leg_.curve, law, trajectory.knots);
    return trajectory;
  }

  /// By how much a trajectory from rest must be slowed down (velocities fall with the factor,
  /// accelerations with its square).
  double needed_factor(const Trajectory& trajectory) const {
    const LimitUse use = limit_use(trajectory, request_.max_velocity, request_.max_acceleration);
    return std::max(use.velocity, std::sqrt(use.acceleration));
  }

  /// Within the limits, or no worse than the start itself.
  bool within_limits(const Trajectory& trajectory) const {
    const auto start_use = [](const JointVector& rate, const JointVector& limit) {
      return std::max(1.0, rate.cwiseAbs().cwiseQuotient(limit).maxCoeff()) * (1 + kRounding);
    };
    const LimitUse use = limit_use(trajectory, request_.max_velocity, request_.max_acceleration);
    return use.velocity <= start_use(request_.from.v, request_.max_velocity) &&
           use.acceleration <= start_use(request_.from.a, request_.max_acceleration);
  }

  /// The time law takes over what it can; the rest fades out in an added quintic. On a straight
  /// line with a fade as long as the leg the sum is the one quintic from the start's state to rest,
  /// so that planning again on the way changes nothing.
  Trajectory from_moving_in(double duration_s) const {
    const JointState& from = request_.from;
    const JointState slope = leg_.curve.at(0);
    const double steepness = slope.v.squaredNorm();
    double speed = 0, acceleration = 0;
    if (steepness > 0) {
      speed = from.v.dot(slope.v) / steepness;
      acceleration = (from.a - speed * speed * slope.a).dot(slope.v) / steepness;
    }
    const TimeLaw law{duration_s, speed, acceleration};
    const JointVector rest = from.v - law.speed(0) * slope.v;
    // A quintic that fades v out in B peaks at 3.94 v/B: half of the limit is enough for it.
    const double gentle = std::max(8 * stopping_time(rest), 0.5 * duration_s);
    return spliced(along(law), from, std::min(duration_s, gentle));
  }

  /// At full deceleration, of the slowest joint.
  double stopping_time(const JointVector& velocity) const {
    return velocity.cwiseAbs().cwiseQuotient(request_.max_acceleration).maxCoeff();
  }

  Expected<Trajectory> shortest_from_moving() const {
    const double needed = std::max(needed_factor(along(TimeLaw{1})), kShortestLeg_s);
    const double first = std::max(kFirstTry * needed, stopping_time(request_.from.v));
    for (int i = 0; i < kMostTries; ++i) {
      const double duration = first * std::pow(kGrowth, i);
      Trajectory found = from_moving_in(duration);
      if (within_limits(found)) return i == 0 ? found : refined(duration, found);
    }
    return refuse(fmt::format("segment {}: no duration keeps the limits from this moving start",
                              leg_.first_segment + 1));
  }

  /// Halves the last step of the search a few times.
  Trajectory refined(double duration, Trajectory found) const {
    double low = duration / kGrowth, high = duration;
    for (int i = 0; i < kRefinements; ++i) {
      const double middle = 0.5 * (low + high);
      Trajectory shorter = from_moving_in(middle);
      const bool fits = within_limits(shorter);
      (fits ? high : low) = middle;
      if (fits) found = std::move(shorter);
    }
    return found;
  }

  tl::unexpected<Reason> too_short(double needed_s) const {
    return refuse(fmt::format("segment {} lasts {:.3f} s, its limits need {:.3f} s",
                              leg_.first_segment + 1, *leg_.duration_s, needed_s));
  }

  const TrajectoryRequest& request_;
  const Leg& leg_;
  PiecesAlong pieces_along_;
};

void append(Trajectory& trajectory, const Trajectory& next) {
  const double offset = trajectory.duration_s();
  for (std::size_t i = 1; i < next.knots.size(); ++i) {
    trajectory.knots.push_back(offset + next.knots[i]);
  }
  trajectory.pieces.insert(trajectory.pieces.end(), next.pieces.begin(), next.pieces.end());
}

bool moves(const JointState& from) {
  return from.v.cwiseAbs().maxCoeff() > kAtRest || from.a.cwiseAbs().maxCoeff() > kAtRest;
}

}  // namespace

JointState state_along(const JointCurve& curve, const TimeLaw& law, double t) {
  const double speed = law.speed(t);
  JointState state = curve.at(law.s(t));
  state.a = speed * speed * state.a + law.acceleration(t) * state.v;
  state.v *= speed;
  return state;
}

Expected<Trajectory> timed(const TrajectoryRequest& request, PiecesAlong pieces_along) {
  auto legs = legs_of(request);
  if (!legs) return tl::unexpected{legs.error()};
  const bool moving = moves(request.from);
  if (moving && (legs->empty() || !legs->front().moves)) {
    const JointVector& here = request.segments.front().q.front();
    legs->insert(legs->begin(), Leg{0, JointCurve{{0, 1}, {here, here}}, false, {}});
  }
  Trajectory trajectory =
      hold_at(request.segments.front().q.front(), request.start, request.goal_id);
  if (legs->empty()) return trajectory;
  trajectory.knots = {0};
  trajectory.pieces.clear();
  for (std::size_t i = 0; i < legs->size(); ++i) {
    const LegTimer timer{request, (*legs)[i], pieces_along};
    auto leg = moving && i == 0 ? timer.from_moving() : timer.from_rest();
    if (!leg) return leg;
    append(trajectory, *leg);
  }
  return trajectory;
}

}  // namespace armature
