// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What a run hears from outside of its own components while it lasts, and what it tells there: the
/// operator's signals, and the deployment's other processes. Called on the thread that runs, at
/// least every 20 ms on the system clock and after every activation on the simulated one. The
/// defaults are those of a run that is alone.
class RunWatch {
 public:
  virtual ~RunWatch() = default;

  /// Before the first activation, again and again: whether the run may begin. `waiting` says which
  /// topic has not met which process yet. May throw std::runtime_error, which ends the run before
  /// it began.
  virtual bool may_start(const std::optional<std::string>& waiting) { return !waiting; }
  /// Why the run is to stop, once something outside of its components says so. Asked before the
  /// start, too, and may throw there as may_start does.
  virtual std::optional<std::string> stop_cause() { return std::nullopt; }
  /// The time behind the time limit after which this process ends the run by itself. A process that
  /// the main one has started waits for that one to do it.
  virtual Duration grace() const { return {}; }
  /// Whether the scenario is over in another process, so that this stop is no trouble.
  virtual bool scenario_over() const { return false; }
  /// Once: the run is stopping, because the scenario is over here or there, or for another reason.
  virtual void stopping(const std::string& cause, bool scenario_over) {
    static_cast<void>(cause);
    static_cast<void>(scenario_over);
  }
  /// While the run is stopping: whether it may end. `moving` names the components that are not at
  /// rest, `left` is how long they may still take.
  virtual bool may_end(const std::vector<std::string>& moving, Duration left) {
    return moving.empty() || left <= Duration{0};
  }
  /// Once, before the components are activated for the last time.
  virtual void ending() {}
};

}  // namespace armature
