// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

constexpr double kNearest_s = 1e-6;   // waypoints nearer in s than this are one
constexpr double kStartGap = 1e-7;    // [rad] or [m] where segments meet, as trajectory_defect
constexpr double kBriefest_s = 1e-6;  // that a segment may be told to last
constexpr double kLeastLimit = 1e-9;  // [rad/s] or [m/s], and of accelerations and jerks
constexpr int kStraightParts = 8;     // of a straight line that runs on through a via

std::string defect(const JointSegment& segment, Eigen::Index dof) {
  if (segment.s.size() < 2 || segment.s.size() != segment.q.size()) {
    return "needs two or more waypoints and an s for each";
  }
  for (const JointVector& q : segment.q) {
    if (q.size() != dof || !q.allFinite()) return "has a waypoint that is not a joint position";
  }
  for (std::size_t i = 1; i < segment.s.size(); ++i) {
    if (!(segment.s[i] > segment.s[i - 1])) return "has waypoints whose s does not ascend";
  }
  const double first = segment.s.front(), last = segment.s.back();
  if (!(std::abs(first) <= kNearest_s && std::abs(last - 1) <= kNearest_s)) {
    return "has an s that does not go from 0 to 1";
  }
  if (!segment.duration_s) return {};
  if (!(*segment.duration_s > 0)) return "lasts no time";
  if (!std::isfinite(*segment.duration_s)) return "lasts for ever";
  if (*segment.duration_s < kBriefest_s || *segment.duration_s > kLongest_s) {
    return fmt::format("lasts {:.3g} s, not {:g} s to {:g} s", *segment.duration_s, kBriefest_s,
                       kLongest_s);
  }
  return {};
}

/// The speeds by which segments are measured: the limits as parts of the smallest one, none so much
/// larger that what its joint goes alone counted for nothing. Without any limit all joints are as
/// fast.
JointVector paces(const JointVector& max_velocity) {
  constexpr double kMostOfSlowest = 1e3;
  const double slowest = max_velocity.minCoeff();
  if (!std::isfinite(slowest)) return JointVector::Ones(max_velocity.size());
  return (max_velocity / slowest)
      .cwiseMin(JointVector::Constant(max_velocity.size(), kMostOfSlowest));
}

/// A measure of a segment's length that lets the speed be about even across vias: the time that the
/// slowest joint needs at full speed.
double length(const JointSegment& segment, const JointVector& pace) {
  double sum = 0;
  for (std::size_t i = 1; i < segment.q.size(); ++i) {
    const auto step = (segment.q[i] - segment.q[i - 1]).cwiseAbs();
    sum += step.cwiseQuotient(pace).maxCoeff();
  }
  return sum;
}

/// A straight line in equal parts, so that the curve stays on it when it runs on behind.
JointSegment divided(const JointSegment& line) {
  JointSegment parts = line;
  parts.s.clear();
  parts.q.clear();
  for (int i = 0; i <= kStraightParts; ++i) {
    const double s = static_cast<double>(i) / kStraightParts;
    parts.s.push_back(s);
    parts.q.push_back((1 - s) * line.q.front() + s * line.q.back());
  }
  return parts;
}

/// Segments [first, end) as one curve over s from 0 to 1.
Leg joined(const TrajectoryRequest& request, std::size_t first, std::size_t end) {
  const JointVector pace = paces(request.max_velocity);
  double total = 0;
  int moving = 0;
  for (std::size_t i = first; i < end; ++i) {
    if (!moves(request.segments[i])) continue;
    total += length(request.segments[i], pace);
    ++moving;
  }
  std::vector<double> s{0};
  std::vector<JointVector> q{request.segments[first].q.front()};
  double done = 0;
  for (std::size_t i = first; i < end && moving > 0; ++i) {
    const JointSegment& given = request.segments[i];
    if (!moves(given)) continue;
    const double share = length(given, pace) / total;
    const JointSegment& segment = moving > 1 && given.q.size() == 2 ? divided(given) : given;
    const double low = segment.s.front(), span = segment.s.back() - low;
    for (std::size_t k = 1; k < segment.s.size(); ++k) {
      const double here = done + share * (segment.s[k] - low) / span;
      if (here - s.back() < kNearest_s) continue;
      s.push_back(here);
      q.push_back(segment.q[k]);
    }
    done += share;
  }
  if (moving == 0) {
    s.push_back(1);
    q.push_back(q.front());
  }
  s.back() = 1;
  q.back() = moving == 0 ? q.front() : request.segments[end - 1].q.back();
  return {first, JointCurve{std::move(s), std::move(q)}, moving > 0,
          request.segments[first].duration_s};
}

}  // namespace

bool moves(const JointSegment& segment) {
  double way = 0;
  for (std::size_t i = 1; i < segment.q.size(); ++i) {
    way += (segment.q[i] - segment.q[i - 1]).cwiseAbs().maxCoeff();
  }
  return way > kStillWay;
}

std::string defect_of(const TrajectoryRequest& request) {
  const Eigen::Index dof = request.from.q.size();
  const auto& from = request.from;
  if (dof == 0 || from.v.size() != dof || from.a.size() != dof || !from.q.allFinite() ||
      !from.v.allFinite() || !from.a.allFinite()) {
    return "the start is not a joint state";
  }
  const auto positive = [&](const JointVector& limit) {
    return limit.size() == dof && (limit.array() > 0).all();
  };
  const bool limits_jerk = request.max_jerk.size() > 0;
  if (!positive(request.max_velocity) || !positive(request.max_acceleration) ||
      (limits_jerk && !positive(request.max_jerk))) {
    return "the limits are not positive numbers, one per joint";
  }
  const double least =
      std::min(request.max_velocity.minCoeff(), request.max_acceleration.minCoeff());
  if (std::min(least, limits_jerk ? request.max_jerk.minCoeff() : least) < kLeastLimit) {
    return fmt::format("a limit is smaller than {:g}", kLeastLimit);
  }
  if (request.segments.empty()) return "there is no segment";
  for (std::size_t i = 0; i < request.segments.size(); ++i) {
    const JointSegment& segment = request.segments[i];
    if (auto what = defect(segment, dof); !what.empty()) {
      return fmt::format("segment {} {}", i + 1, what);
    }
    const bool from_stop = i == 0 || request.segments[i - 1].stop_at_end;
    if (segment.duration_s && !(segment.stop_at_end && from_stop)) {
      return fmt::format("segment {} has its own duration but does not run from stop to stop",
                         i + 1);
    }
    const JointVector& before = i == 0 ? from.q : request.segments[i - 1].q.back();
    const double gap = (segment.q.front() - before).cwiseAbs().maxCoeff();
    if (gap > kStartGap) {
      return fmt::format("segment {} starts {:.3g} away from where it should", i + 1, gap);
    }
  }
  return {};
}

Expected<std::vector<Leg>> legs_of(const TrajectoryRequest& request) {
  if (auto what = defect_of(request); !what.empty()) return refuse(what);
  std::vector<Leg> legs;
  std::size_t first = 0;
  for (std::size_t i = 0; i < request.segments.size(); ++i) {
    const bool last = i + 1 == request.segments.size();
    if (!request.segments[i].stop_at_end && !last) continue;
    Leg leg = joined(request, first, i + 1);
    if (leg.moves || leg.duration_s) legs.push_back(std::move(leg));
    first = i + 1;
  }
  return legs;
}

}  // namespace armature
