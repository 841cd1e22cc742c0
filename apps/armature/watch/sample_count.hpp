// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "watch/topics.hpp"

namespace armature {

/// The samples of a topic that were seen: enough of them end a watch, as do the time that was given
/// and the operator.
class SampleCount {
 public:
  /// `least`: how many samples are of use when the options ask for no number.
  SampleCount(const TopicOptions& options, std::uint64_t least)
      : options_{options}, least_{least} {}
  /// Whether no more are wanted. Any thread.
  bool full() const { return ended_ || (options_.count > 0 && seen_ >= options_.count); }
  void add() { ++seen_; }
  void end() { ended_ = true; }
  /// kTimedOut, and a line that says so, when fewer samples than wanted came in the time given.
  int wait(const std::function<void()>& every_second = [] {});

 private:
  int timed_out() const;

  TopicOptions options_;
  std::uint64_t least_;
  std::atomic<std::uint64_t> seen_{0};
  std::atomic<bool> ended_{false};
};

}  // namespace armature
