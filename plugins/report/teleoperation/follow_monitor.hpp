// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "armature/values/expected.hpp"
#include "report_teleoperation_parameters.hpp"
#include "track.hpp"

namespace armature::report::teleoperation {

/// Watches a follower that a hand leads; the follower's points are told along the leader's axes,
/// from any origin. Times in [s].
class FollowMonitor {
 public:
  explicit FollowMonitor(const Parameters& parameters) : parameters_{parameters} {}

  /// Where the hand means to be, where it is, and where the follower's tip is.
  void see_intended(const TrackPoint& point) { add(point, intended_); }
  void see_hand(const TrackPoint& point) { add(point, hand_); }
  void see_follower(const TrackPoint& point);
  /// Every change; open before the first.
  void see_clutch(bool closed, double t);

  /// Of the follower from the intended way, scaled, that much later. Where either began plays no
  /// part (the clutch), so the mean of each stretch is taken off.
  struct Following {
    double rms_m = 0, worst_m = 0;
    /// With which the rms would be least, or why nobody can say: that is not between the two below,
    /// or the rms is hardly another one with another lag.
    Expected<double> lag_s;
  };
  static constexpr double kMinLag_s = -0.1, kMaxLag_s = 1.1;
  std::optional<Following> following() const;

  /// The hand's tremor, and what the follower has of it; rms [m]. Refused while the clutch
  /// was never closed for long enough.
  struct Tremor {
    double hand_m = 0, follower_m = 0;
    double left_db = 0;  // the follower's, over scale times the hand's
  };
  Expected<Tremor> tremor() const;

  /// The farthest that the follower went while the clutch was open, once it stood.
  std::optional<double> open_motion_m() const;
  /// How far it went until then.
  std::optional<double> stopping_m() const;
  /// The longest step of the follower, from one point to the next, as the clutch closes.
  std::optional<double> closing_step_m() const;
  const std::optional<double>& top_speed_m_s() const { return top_speed_m_s_; }

 private:
  /// Before the clutch was first closed only the last seconds are kept.
  void add(const TrackPoint& point, Track& track) const;

  struct Stretch {
    double from, to;
  };
  /// With the clutch closed, or open after it was closed, up to the last point of the follower.
  std::vector<Stretch> stretches(bool closed) const;

  /// Which of the follower's points are compared: every so many in that time.
  struct Sample {
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();
    std::size_t every = 1;
  };
  /// Sums over these points: how far they are off, along how it changes with the lag.
  struct Comparison {
    double squares = 0, along = 0, rates = 0, count = 0;
    double worst_m = 0;
  };
  Comparison compare(double lag_s, const Sample& sample) const;
  /// All, or of a run of minutes so many that the search for the lag does not take as long.
  Sample fine() const;
  /// The least rms of all lags may be one of several minima: a search first, then steps.
  std::optional<double> coarse_lag() const;
  Expected<double> best_lag() const;
  /// Whether the rms is least there by enough to be told from its neighbours'.
  bool stands_out(double lag_s) const;
  static constexpr double kLagStep_s = 0.01, kTellsApart_s = 0.1;

  Parameters parameters_;
  Track intended_, hand_, follower_;
  struct ClutchChange {
    bool closed;
    double t;
  };
  std::vector<ClutchChange> clutch_;
  std::optional<double> top_speed_m_s_;
};

}  // namespace armature::report::teleoperation
