// SPDX-License-Identifier: Apache-2.0
#include "follow_monitor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "band_power.hpp"

namespace armature::report::teleoperation {
namespace {

using Eigen::Vector3d;

constexpr double kTremorFrom_hz = 8, kTremorTo_hz = 12;
constexpr double kSettles_s = 0.5;  // after the clutch has closed, before the following is judged
constexpr double kStops_s = 0.1;    // after the clutch has opened, until the follower must stand
constexpr double kCloses_s = 0.05;  // after it has closed: no jump in this time

bool before(const TrackPoint& point, double t) { return point.t < t; }

/// The points from `from` on, before `to`.
std::span<const TrackPoint> between(const Track& track, double from, double to) {
  const auto first = std::lower_bound(track.begin(), track.end(), from, before);
  const auto last = std::lower_bound(first, track.end(), to, before);
  return {first, last};
}

/// Between the two points next to `t`; none outside the track.
std::optional<Vector3d> position_at(const Track& track, double t) {
  const auto next = std::lower_bound(track.begin(), track.end(), t, before);
  if (next == track.end() || (next == track.begin() && t < next->t)) return std::nullopt;
  if (next->t == t) return next->position;
  const auto last = std::prev(next);
  const double share = (t - last->t) / (next->t - last->t);
  return last->position + share * (next->position - last->position);
}

void subtract_mean(std::vector<Vector3d>& values) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& value : values) mean += value / static_cast<double>(values.size());
  for (Vector3d& value : values) value -= mean;
}

void keep_largest(std::optional<double>& kept, double value) {
  kept = std::max(kept.value_or(0), value);
}

}  // namespace

void FollowMonitor::add(const TrackPoint& point, Track& track) const {
  constexpr double kKept_s = 2;  // more than any lag
  track.push_back(point);
  if (!clutch_.empty() || point.t - track.front().t < 2 * kKept_s) return;
  track.erase(track.begin(),
              std::ranges::lower_bound(track, point.t - kKept_s, {}, &TrackPoint::t));
}

void FollowMonitor::see_follower(const TrackPoint& point) {
  if (!follower_.empty() && point.t > follower_.back().t) {
    const TrackPoint& last = follower_.back();
    keep_largest(top_speed_m_s_, (point.position - last.position).norm() / (point.t - last.t));
  }
  add(point, follower_);
}

void FollowMonitor::see_clutch(bool closed, double t) {
  const bool was_closed = !clutch_.empty() && clutch_.back().closed;
  if (closed != was_closed) clutch_.push_back({closed, t});
}

std::vector<FollowMonitor::Stretch> FollowMonitor::stretches(bool closed) const {
  std::vector<Stretch> found;
  if (follower_.empty()) return found;
  for (std::size_t i = 0; i < clutch_.size(); ++i) {
    if (clutch_[i].closed != closed) continue;
    const bool last = i + 1 == clutch_.size();
    found.push_back({clutch_[i].t, last ? follower_.back().t : clutch_[i + 1].t});
  }
  return found;
}

FollowMonitor::Comparison FollowMonitor::compare(double lag_s, const Sample& sample) const {
  constexpr double kHalfStep = 5e-4;  // [s] of the difference quotient
  Comparison result;
  for (const Stretch& stretch : stretches(true)) {
    const auto points = between(follower_, std::max(stretch.from + kSettles_s, sample.from),
                                std::min(stretch.to, sample.to));
    std::vector<Vector3d> off, rate;
    for (std::size_t i = 0; i < points.size(); i += sample.every) {
      const double t = points[i].t - lag_s;
      const auto meant = position_at(intended_, t), last = position_at(intended_, t - kHalfStep),
                 next = position_at(intended_, t + kHalfStep);
      if (!meant || !last || !next) continue;
      off.push_back(points[i].position - parameters_.scale * *meant);
      rate.push_back(parameters_.scale * (*next - *last) / (2 * kHalfStep));
    }
    subtract_mean(off);
    subtract_mean(rate);
    for (std::size_t i = 0; i < off.size(); ++i) {
      result.squares += off[i].squaredNorm();
      result.along += off[i].dot(rate[i]);
      result.rates += rate[i].squaredNorm();
      result.worst_m = std::max(result.worst_m, off[i].norm());
    }
    result.count += static_cast<double>(off.size());
  }
  return result;
}

std::optional<double> FollowMonitor::coarse_lag() const {
  constexpr std::size_t kEnough = 2000;  // points, however long the run was
  if (intended_.empty()) return std::nullopt;
  // The same points at every lag: else the lag that leaves out the worst of them would be best.
  const Sample sample{.from = intended_.front().t + kMaxLag_s + kLagStep_s,
                      .to = intended_.back().t + kMinLag_s - kLagStep_s,
                      .every = 1 + follower_.size() / kEnough};
  const int last = static_cast<int>(std::lround((kMaxLag_s - kMinLag_s) / kLagStep_s));
  int best = 0;
  double least = compare(kMinLag_s, sample).squares;
  for (int i = 1; i <= last; ++i) {
    const double squares = compare(kMinLag_s + i * kLagStep_s, sample).squares;
    if (squares >= least) continue;
    least = squares;
    best = i;
  }
  if (best == 0 || best == last) return std::nullopt;
  return kMinLag_s + best * kLagStep_s;
}

FollowMonitor::Sample FollowMonitor::fine() const {
  constexpr std::size_t kEnough = 100'000;
  return {.every = 1 + follower_.size() / kEnough};
}

bool FollowMonitor::stands_out(double lag_s) const {
  const auto mean_square = [&](double lag) {
    const Comparison there = compare(lag, fine());
    return there.squares / there.count;
  };
  constexpr double kMore = 1.2;  // a tenth more rms: far above what noise makes of it
  const double clearly = kMore * mean_square(lag_s);
  return mean_square(lag_s - kTellsApart_s) > clearly &&
         mean_square(lag_s + kTellsApart_s) > clearly;
}

Expected<double> FollowMonitor::best_lag() const {
  constexpr int kMaxSteps = 20;
  constexpr double kExact_s = 1e-9;
  const auto coarse = coarse_lag();
  if (!coarse) {
    return refuse(
        fmt::format("no lag between {:g} and {:g} ms fits best", 1e3 * kMinLag_s, 1e3 * kMaxLag_s));
  }
  double lag = *coarse;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Comparison here = compare(lag, fine());
    if (!(here.rates > 0)) break;
    // off grows by rate for every second that the way is taken later: least squares in that.
    const double next =
        std::clamp(lag - here.along / here.rates, *coarse - kLagStep_s, *coarse + kLagStep_s);
    const double step = std::abs(next - lag);
    lag = next;
    if (step < kExact_s) break;
  }
  if (!stands_out(lag)) {
    return refuse(
        fmt::format("the motion does not tell: a lag {:g} ms longer or shorter than the "
                    "one that fits best fits nearly as well",
                    1e3 * kTellsApart_s));
  }
  return lag;
}

std::optional<FollowMonitor::Following> FollowMonitor::following() const {
  const Comparison stated = compare(parameters_.lag, {});
  if (stated.count == 0) return std::nullopt;
  return Following{.rms_m = std::sqrt(stated.squares / stated.count),
                   .worst_m = stated.worst_m,
                   .lag_s = best_lag()};
}

Expected<FollowMonitor::Tremor> FollowMonitor::tremor() const {
  constexpr double kEnough_s = 2;  // in less the hand's own way leaks into the band
  double hand = 0, follower = 0, duration = 0;
  for (const Stretch& stretch : stretches(true)) {
    const double from = stretch.from + kSettles_s, lasts = stretch.to - from;
    if (lasts < kEnough_s) continue;
    hand += lasts * band_power(between(hand_, from, stretch.to), kTremorFrom_hz, kTremorTo_hz);
    follower +=
        lasts * band_power(between(follower_, from, stretch.to), kTremorFrom_hz, kTremorTo_hz);
    duration += lasts;
  }
  if (duration == 0) {
    return refuse(
        fmt::format("the clutch was never closed for {:g} s on end", kSettles_s + kEnough_s));
  }
  return Tremor{
      .hand_m = std::sqrt(hand / duration),
      .follower_m = std::sqrt(follower / duration),
      .left_db = 10 * std::log10(follower / (parameters_.scale * parameters_.scale * hand))};
}

std::optional<double> FollowMonitor::open_motion_m() const {
  std::optional<double> farthest;
  for (const Stretch& stretch : stretches(false)) {
    const auto stands = between(follower_, stretch.from + kStops_s, stretch.to);
    for (const TrackPoint& point : stands) {
      keep_largest(farthest, (point.position - stands.front().position).norm());
    }
  }
  return farthest;
}

std::optional<double> FollowMonitor::stopping_m() const {
  std::optional<double> farthest;
  for (const Stretch& stretch : stretches(false)) {
    const double stands = std::min(stretch.from + kStops_s, stretch.to);
    const auto stopping = between(follower_, stretch.from, stands);
    if (stopping.empty()) continue;
    keep_largest(farthest, (stopping.back().position - stopping.front().position).norm());
  }
  return farthest;
}

std::optional<double> FollowMonitor::closing_step_m() const {
  std::optional<double> longest;
  for (const Stretch& stretch : stretches(true)) {
    const auto closing = between(follower_, stretch.from, stretch.from + kCloses_s);
    for (std::size_t i = 1; i < closing.size(); ++i) {
      keep_largest(longest, (closing[i].position - closing[i - 1].position).norm());
    }
  }
  return longest;
}

}  // namespace armature::report::teleoperation
