// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "armature/runtime/deployment_file/executor_spec.hpp"
#include "armature/values/chance.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// When an executor's thread is held up on the simulated clock, as a busy machine holds one up:
/// again and again, for a while that is drawn evenly up to the longest, after a time that is drawn
/// evenly up to four times the longest. A fifth of the time in all.
class SimulatedPauses {
 public:
  explicit SimulatedPauses(const ExecutorSpec& executor)
      : longest_{executor.sim_pause}, chance_{executor.seed} {}

  /// When the thread does what is due at `time`: then, or at the end of the pause that it is in.
  /// The times that it is asked for do not go back.
  Time awake(Time time) {
    if (longest_.count() == 0) return time;
    while (time >= end_) {
      begin_ = end_ + 4 * share();
      end_ = begin_ + share();
    }
    return time < begin_ ? time : end_;
  }

 private:
  Duration share() { return Duration{1} + seconds(to_seconds(longest_) * chance_.share()); }

  Duration longest_;
  Chance chance_;
  Time begin_, end_;
};

}  // namespace armature
