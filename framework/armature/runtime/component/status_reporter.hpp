// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "armature/values/real_time_mutex.hpp"

namespace armature ARMATURE_EXPORT {

/// What a component tells about itself, kept for the operator and for state messages. From any
/// thread.
class StatusReporter {
 public:
  enum class State { ok, degraded, fault, stalled };
  struct Status {
    State state = State::ok;
    std::string reason;
  };
  /// `state`: what the line is about; `ok` for whatever is no trouble. As real-time safe as the
  /// components that speak.
  using Sink = std::function<void(std::string_view component, std::string_view line, State state)>;

  StatusReporter(std::string component, Sink sink);

  /// Both are real-time safe; what is longer than `kMaxText` is cut.
  void log(std::string_view text);
  void set(State state, std::string_view reason);
  /// From now on what is set is kept, and no line tells of it: of a component that rests in a run
  /// that is stopping. A fault is told all the same. False: as before. Real-time safe.
  void keep_to_itself(bool quiet);
  Status status() const;

  static constexpr std::size_t kMaxText = 900;

 private:
  std::string component_;
  Sink sink_;
  mutable RealTimeMutex mutex_;
  std::string last_line_;
  Status status_;
  bool quiet_ = false;
};

}  // namespace armature
