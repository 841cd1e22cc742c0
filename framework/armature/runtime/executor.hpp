// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "armature/runtime/clock.hpp"
#include "armature/runtime/unit.hpp"

namespace armature {

/// One entry of `executors:` in a deployment.
struct ExecutorSpec {
  std::string name;
  std::optional<Duration> period;  // activates all its components; none: triggers and own periods
  int priority = 0;                // SCHED_FIFO 1..99; 0: the normal scheduler
  std::optional<int> cpu;          // pinned to this one
};

/// A named thread that activates the units assigned to it, in the order of the graph. A period
/// that was missed is skipped and counted, never caught up in a burst.
class Executor {
 public:
  Executor(ExecutorSpec spec, const Clock& clock);
  ~Executor();

  void assign(Unit& unit);
  /// Starts the thread; the note says what of the specification the system did not allow.
  void start(const std::function<void(const std::string&)>& note);
  void request_stop();
  void join();
  const std::string& name() const { return spec_.name; }
  int first_place() const;

 private:
  struct Entry {
    Unit* unit;
    std::optional<Duration> period;
    Time next_release;
    std::atomic<bool>* triggered;
  };
  void loop();
  void activate_due();
  std::optional<Time> next_release() const;

  ExecutorSpec spec_;
  const Clock* clock_;
  std::vector<Entry> entries_;
  std::vector<std::unique_ptr<std::atomic<bool>>> flags_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool woken_ = false;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace armature
