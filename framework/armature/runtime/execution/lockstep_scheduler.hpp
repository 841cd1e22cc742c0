// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/execution/scheduler.hpp"
#include "armature/runtime/execution/simulated_pauses.hpp"

namespace armature ARMATURE_EXPORT {

/// The simulated clock's scheduler: one thread, events in the order (time, place in the graph,
/// sequence), as fast as the machine allows. Same file, same binary: same bytes on every run.
class LockstepScheduler final : public Scheduler {
 public:
  explicit LockstepScheduler(SimulatedClock& clock) : clock_{&clock} {}

  void assign(const ExecutorSpec& executor, const std::vector<ComponentRunner*>& runners) override;
  void run(const std::function<bool()>& done) override;
  void begin_stop() override;
  /// Drops what is on its way too: its samples belong to topics, which go before the scheduler.
  std::vector<const ComponentRunner*> stop(Duration) override {
    events_ = {};
    return {};
  }
  void publish(Topic& topic, SampleRef sample) override;

 private:
  struct Entry {
    ComponentRunner* runner;
    SimulatedPauses* pauses;  // of its executor
    std::optional<Duration> period;
    bool is_triggered = false;  // an activation by trigger is already queued
    Time triggered, activated;  // last
  };
  struct Event {
    Time time;
    Time due = time;  // without a pause of its executor
    int place;
    std::uint64_t sequence = 0;
    Entry* activate = nullptr;  // else: hand over `sample` on `topic`
    bool periodic = false;
    Topic* topic = nullptr;
    SampleRef sample{};
  };
  struct Later {
    bool operator()(const Event& a, const Event& b) const {
      return std::tie(a.time.ns, a.place, a.sequence) > std::tie(b.time.ns, b.place, b.sequence);
    }
  };
  void add(ComponentRunner& runner, SimulatedPauses& pauses, std::optional<Duration> period);
  void schedule(Event event);
  void handle(Event& event);

  SimulatedClock* clock_;
  std::deque<SimulatedPauses> pauses_;  // of every executor
  std::deque<Entry> entries_;
  std::priority_queue<Event, std::vector<Event>, Later> events_;
  std::uint64_t next_sequence_ = 0;
  Entry* running_ = nullptr;
};

}  // namespace armature
