// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "armature/runtime/component/output_port.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "armature/runtime/execution/executor.hpp"

namespace armature ARMATURE_EXPORT {

/// Decides when components are activated. Two of them: threads on the system clock, lockstep on the
/// simulated one.
class Scheduler : public Delivery {
 public:
  /// Gives `runners` (in graph order) to an executor. Before `run`.
  virtual void assign(const ExecutorSpec& executor,
                      const std::vector<ComponentRunner*>& runners) = 0;
  /// Runs until `done` (asked at least every 20 ms of the wall clock and after every activation
  /// of the simulated one) says so. Components go on being activated on the system clock when it
  /// has returned; called again it goes on where it was.
  virtual void run(const std::function<bool()>& done) = 0;
  /// Tells every component to come to rest; they go on being activated.
  virtual void begin_stop() = 0;
  /// Stops activating, sources first; returns when no step runs any more. A step that has not
  /// returned after `timeout` is left behind: its component is in the answer, and neither it nor
  /// the scheduler may be touched or destroyed any more.
  virtual std::vector<const ComponentRunner*> stop(Duration timeout) = 0;
};

}  // namespace armature
