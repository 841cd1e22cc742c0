// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

// A moving start is tried with longer and longer durations, from this part of what the leg needs
// from rest or the velocity needs to vanish; 1.25^39 is 6000 times longer.
constexpr double kFirstTry = 0.3, kGrowth = 1.25;
constexpr int kMaxTries = 40, kRefinements = 6;

/// One leg on its own clock, and how it is allowed to use the limits.
class LegTimer {
 public:
  LegTimer(const TrajectoryRequest& request, const Leg& leg, const LegShape& shape)
      : request_{request}, leg_{leg}, shape_{shape} {}

  Expected<Trajectory> from_rest() const {
    const Trajectory unit = shape_.in(1, rest());
    const double needed = needed_factor(request_, unit);
    if (!(needed <= kLongest_s)) return too_long(needed);
    if (!leg_.duration_s)
      return stretched(unit, std::max(needed * (1 + kLimitRounding), kShortestLeg_s));
    if (needed > *leg_.duration_s * (1 + kLimitRounding)) return too_short(needed);
    return shape_.in(*leg_.duration_s, rest());
  }

  Expected<Trajectory> from_moving() const {
    if (leg_.duration_s) {
      Trajectory fixed = shape_.in(*leg_.duration_s, request_.from);
      if (within_limits(fixed)) return fixed;
      const auto shortest = shortest_from_moving();
      return shortest ? too_short(shortest->duration_s()) : shortest;
    }
    return shortest_from_moving();
  }

 private:
  JointState rest() const {
    const JointVector& q = leg_.curve.waypoints().front();
    return {q, JointVector::Zero(q.size()), JointVector::Zero(q.size())};
  }

  /// Within the limits, or no worse than the start itself.
  bool within_limits(const Trajectory& trajectory) const {
    const auto start_use = [](const JointVector& rate, const JointVector& limit) {
      return std::max(1.0, rate.cwiseAbs().cwiseQuotient(limit).maxCoeff()) * (1 + kLimitRounding);
    };
    const LimitUse use = limit_use(trajectory, request_.max_velocity, request_.max_acceleration);
    return use.velocity <= start_use(request_.from.v, request_.max_velocity) &&
           use.acceleration <= start_use(request_.from.a, request_.max_acceleration) &&
           jerk_use(trajectory, request_.max_jerk) <= 1 + kLimitRounding;
  }

  Expected<Trajectory> shortest_from_moving() const {
    const double needed = std::max(needed_factor(request_, shape_.in(1, rest())), kShortestLeg_s);
    const double stopping =
        request_.from.v.cwiseAbs().cwiseQuotient(request_.max_acceleration).maxCoeff();
    const double first = std::max(kFirstTry * needed, stopping);
    if (!(first <= kLongest_s)) return too_long(first);
    for (int i = 0; i < kMaxTries; ++i) {
      const double duration = first * std::pow(kGrowth, i);
      Trajectory found = shape_.in(duration, request_.from);
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
      Trajectory shorter = shape_.in(middle, request_.from);
      const bool fits = within_limits(shorter);
      (fits ? high : low) = middle;
      if (fits) found = std::move(shorter);
    }
    return found;
  }

  tl::unexpected<Reason> too_long(double needed_s) const {
    return refuse(
        fmt::format("segment {} takes {:.3g} s within its limits, {:g} s at most are planned",
                    leg_.first_segment + 1, needed_s, kLongest_s));
  }
  tl::unexpected<Reason> too_short(double needed_s) const {
    return refuse(fmt::format("segment {} lasts {:.3f} s, its limits need {:.3f} s",
                              leg_.first_segment + 1, *leg_.duration_s, needed_s));
  }

  const TrajectoryRequest& request_;
  const Leg& leg_;
  const LegShape& shape_;
};

void append(Trajectory& trajectory, const Trajectory& next) {
  const double offset = trajectory.duration_s();
  for (std::size_t i = 1; i < next.knots.size(); ++i) {
    trajectory.knots.push_back(offset + next.knots[i]);
  }
  trajectory.pieces.insert(trajectory.pieces.end(), next.pieces.begin(), next.pieces.end());
}

}  // namespace

double needed_factor(const TrajectoryRequest& request, const Trajectory& from_rest) {
  const LimitUse use = limit_use(from_rest, request.max_velocity, request.max_acceleration);
  return std::max({use.velocity, std::sqrt(use.acceleration),
                   std::cbrt(jerk_use(from_rest, request.max_jerk))});
}

Expected<Trajectory> timed(const TrajectoryRequest& request, const LegShaper& shape_of) {
  auto legs = legs_of(request);
  if (!legs) return tl::unexpected{legs.error()};
  const bool moving = !at_rest(request.from);
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
    const auto shape = shape_of(request, (*legs)[i]);
    const LegTimer timer{request, (*legs)[i], *shape};
    auto leg = moving && i == 0 ? timer.from_moving() : timer.from_rest();
    if (!leg) return leg;
    append(trajectory, *leg);
  }
  return trajectory;
}

}  // namespace armature
