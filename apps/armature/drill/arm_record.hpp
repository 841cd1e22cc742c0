// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "armature/values/time.hpp"

namespace armature::drill {

using Arrival = std::chrono::steady_clock::time_point;

/// One sample of an arm's measured_js, as somebody outside hears it: all joints, [rad] or [m].
struct ArmSample {
  Time stamp;       // of the deployment's clock
  Arrival arrival;  // of the listener's
  std::vector<double> q, v;
};

/// A joint as the robot file has it; its limit in [rad/s] or [m/s].
struct JointLimit {
  std::string name;
  double max_velocity;
};

/// A speed that a joint had, and when.
struct JointSpeed {
  std::string joint;
  double speed = 0;  // [rad/s] or [m/s]
  Arrival arrival;
};

/// Whether an arm that has this speed rests, in rad/s or m/s.
constexpr bool rests(double speed) { return speed < 1e-3; }

/// Whether an arm that has this speed goes somewhere, in rad/s or m/s: faster than one that holds.
constexpr bool moves(double speed) { return speed > 5e-3; }

/// All that was heard of an arm, and what can be said of it: only what the samples themselves show,
/// by their own velocities and by their differences.
class ArmRecord {
 public:
  explicit ArmRecord(std::vector<JointLimit> limits) : limits_{std::move(limits)} {}

  /// A sample with another number of joints, or with a stamp that is not newer, is counted and not
  /// kept.
  void add(ArmSample sample);

  /// The same record without what arrived later.
  ArmRecord until(Arrival end) const;

  const std::vector<ArmSample>& samples() const { return samples_; }
  int unusable() const { return unusable_; }

  /// The speed of the fastest joint in the newest sample, by its own velocity; 0 without one.
  double speed_now() const;
  /// The fastest joint of the last 20 ms; nothing without samples. An arm that rests before its
  /// process ends rests there.
  std::optional<JointSpeed> speed_at_end() const;
  /// The first joint that was faster than its limit and 5 % of it, by differences over at least
  /// 5 ms: a jump is a high speed, too.
  std::optional<JointSpeed> beyond_limit() const;
  /// How long after `from` the last sample arrived that did not rest; 0 when all did.
  Duration time_to_rest(Arrival from) const;
  /// The first movement after the arm, moving at `from` or later, had rested for 0.2 s.
  std::optional<JointSpeed> moved_again(Arrival from) const;
  /// The first movement that arrived later than `from`.
  std::optional<JointSpeed> moves_after(Arrival from) const;
  /// Whether a sample arrived later than `from` that moves faster than what an arm does that holds.
  bool goes_on_after(Arrival from) const;

 private:
  JointSpeed fastest_of(const ArmSample& sample) const;
  JointSpeed fastest_between(const ArmSample& a, const ArmSample& b) const;

  std::vector<JointLimit> limits_;
  std::vector<ArmSample> samples_;
  int unusable_ = 0;
};

}  // namespace armature::drill
