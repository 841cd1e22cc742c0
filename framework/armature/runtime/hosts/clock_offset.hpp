// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// How far another clock is ahead of ours, from questions for its time. The true offset lies within
/// half of the round trip of what an answer tells, however the way there and the way back differ,
/// so the quickest of the last answers is believed (as NTP's clock filter does, RFC 5905,
/// section 10). Not for several threads.
class ClockOffset {
 public:
  struct Estimate {
    Duration offset;      // the other clock minus ours
    Duration round_trip;  // of the question that told it
  };

  /// Asked at `asked`, and answered at `answered`, by our clock, with the time `told`.
  void add(Time asked, Time told, Time answered);
  std::size_t answers() const { return answers_.size(); }
  /// Nothing before the first answer.
  std::optional<Estimate> estimate() const;

 private:
  static constexpr std::size_t kRemembered = 16;
  std::deque<Estimate> answers_;
};

}  // namespace armature
