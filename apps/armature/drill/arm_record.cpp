// SPDX-License-Identifier: Apache-2.0
#include "drill/arm_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace armature::drill {
namespace {

/// A value that is no number counts as faster than any limit.
void raise(JointSpeed& fastest, const std::string& joint, double speed) {
  if (std::isnan(speed)) speed = std::numeric_limits<double>::infinity();
  if (speed <= fastest.speed) return;
  fastest.joint = joint;
  fastest.speed = speed;
}

}  // namespace

void ArmRecord::add(ArmSample sample) {
  const bool whole = sample.q.size() == limits_.size() && sample.v.size() == limits_.size();
  const bool newer = samples_.empty() || sample.stamp > samples_.back().stamp;
  if (whole && newer) {
    samples_.push_back(std::move(sample));
  } else {
    ++unusable_;
  }
}

ArmRecord ArmRecord::until(Arrival end) const {
  ArmRecord record = *this;
  std::erase_if(record.samples_, [&](const ArmSample& sample) { return sample.arrival > end; });
  return record;
}

JointSpeed ArmRecord::fastest_of(const ArmSample& sample) const {
  JointSpeed fastest{.joint = {}, .speed = 0, .arrival = sample.arrival};
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    raise(fastest, limits_[i].name, std::abs(sample.v[i]));
  }
  return fastest;
}

JointSpeed ArmRecord::fastest_between(const ArmSample& a, const ArmSample& b) const {
  JointSpeed fastest{.joint = {}, .speed = 0, .arrival = b.arrival};
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const double speed = std::abs(b.q[i] - a.q[i]) / to_seconds(b.stamp - a.stamp);
    raise(fastest, limits_[i].name, speed);
  }
  return fastest;
}

double ArmRecord::speed_now() const {
  return samples_.empty() ? 0 : fastest_of(samples_.back()).speed;
}

std::optional<JointSpeed> ArmRecord::speed_at_end() const {
  constexpr Duration kEnd = seconds(0.02);
  if (samples_.empty()) return std::nullopt;
  const ArmSample& last = samples_.back();
  JointSpeed fastest = fastest_of(last);
  for (auto sample = samples_.rbegin() + 1;
       sample != samples_.rend() && last.stamp - sample->stamp <= kEnd; ++sample) {
    for (const JointSpeed& speed : {fastest_of(*sample), fastest_between(*sample, *(sample - 1))}) {
      if (speed.speed > fastest.speed) fastest = speed;
    }
  }
  return fastest;
}

std::optional<JointSpeed> ArmRecord::beyond_limit() const {
  constexpr Duration kWindow = seconds(0.005);
  constexpr double kTolerance = 1.05;
  std::size_t first = 0;
  for (const ArmSample& sample : samples_) {
    // The newest sample that is a window older.
    while (first + 1 < samples_.size() && samples_[first + 1].stamp <= sample.stamp - kWindow)
      ++first;
    const ArmSample& before = samples_[first];
    if (sample.stamp - before.stamp < kWindow) continue;
    const double dt = to_seconds(sample.stamp - before.stamp);
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      const double speed = std::abs(sample.q[i] - before.q[i]) / dt;
      if (speed <= kTolerance * limits_[i].max_velocity) continue;
      return JointSpeed{.joint = limits_[i].name, .speed = speed, .arrival = sample.arrival};
    }
  }
  return std::nullopt;
}

Duration ArmRecord::time_to_rest(Arrival from) const {
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    if (sample->arrival <= from) break;
    if (!rests(fastest_of(*sample).speed)) return sample->arrival - from;
  }
  return Duration{0};
}

std::optional<JointSpeed> ArmRecord::moved_again(Arrival from) const {
  constexpr Duration kRest = seconds(0.2);
  bool moved = false;
  std::optional<Time> rests_since;
  for (const ArmSample& sample : samples_) {
    if (sample.arrival < from) continue;
    const JointSpeed fastest = fastest_of(sample);
    if (rests(fastest.speed)) {
      if (moved && !rests_since) rests_since = sample.stamp;
      continue;
    }
    if (rests_since && sample.stamp - *rests_since >= kRest) return fastest;
    rests_since.reset();
    moved = true;
  }
  return std::nullopt;
}

std::optional<JointSpeed> ArmRecord::moves_after(Arrival from) const {
  for (const ArmSample& sample : samples_) {
    if (sample.arrival <= from) continue;
    if (const JointSpeed fastest = fastest_of(sample); !rests(fastest.speed)) return fastest;
  }
  return std::nullopt;
}

bool ArmRecord::goes_on_after(Arrival from) const {
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    if (sample->arrival <= from) break;
    if (moves(fastest_of(*sample).speed)) return true;
  }
  return false;
}

}  // namespace armature::drill
