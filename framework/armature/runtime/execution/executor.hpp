// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "armature/runtime/deployment_file/executor_spec.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "armature/runtime/execution/rate_limiter.hpp"
#include "armature/values/wake_up.hpp"

namespace armature ARMATURE_EXPORT {

/// A named thread that activates the components assigned to it, in the order of the graph. A period
/// that was missed is skipped and counted, never caught up in a burst. Once it runs it neither
/// allocates nor waits for a lock of its own; what its components do is theirs.
class Executor {
 public:
  Executor(ExecutorSpec spec, const Clock& clock);
  ~Executor();

  void assign(ComponentRunner& runner);
  /// Starts the thread, and returns when it is as the specification says and about to take its
  /// first step; `note` says what the system did not allow. While it runs `on_late` says, in its
  /// thread and about once in 10 s, whose step made a component with a period come late.
  void start(const std::function<void(const std::string&)>& note,
             std::function<void(const std::string&)> on_late = {});
  /// Makes every component come to rest (Component::begin_stop), at once or when its running step
  /// is over; steps go on. Any thread.
  void begin_stop();
  void request_stop();
  void join();
  /// Waits for the thread's end for at most `timeout`; false when a step has not returned until
  /// then.
  bool join_for(Duration timeout);
  /// The component whose step is running, or nullptr. Any thread.
  const ComponentRunner* running() const { return running_.load(std::memory_order_acquire); }
  const std::string& name() const { return spec_.name; }
  int first_place() const;
  /// Of its cycles: of all the steps that were due together. Any thread.
  const CycleTimes& times() const { return times_; }

 private:
  struct Entry {
    ComponentRunner* runner;
    std::optional<Duration> period;
    Time next_release;
    std::atomic<std::int64_t>* triggered_ns;  // since when, or kNever
    Time stepped_until{};                     // its last step, and how long that took
    Duration step_took{0};
  };
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

  bool has_period() const;
  void loop();
  void activate_due();
  void step(Entry& entry, Time now, Time release);
  void tell_late(const Entry& late, Time now, Time release);
  static std::optional<Time> take_release(Entry& entry, Time now);
  std::optional<Time> next_release() const;

  ExecutorSpec spec_;
  const Clock* clock_;
  std::vector<Entry> entries_;
  std::vector<std::unique_ptr<std::atomic<std::int64_t>>> triggers_;
  WakeUp wake_;
  CycleTimes times_;
  std::function<void(const std::string&)> on_late_;
  RateLimiter late_notes_{std::chrono::seconds{10}};
  std::atomic<bool> stopping_{false};
  std::atomic<const ComponentRunner*> running_{nullptr};
  std::promise<void> end_;
  std::future<void> ended_ = end_.get_future();
  std::thread thread_;
};

}  // namespace armature
