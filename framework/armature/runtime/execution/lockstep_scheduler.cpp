// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/lockstep_scheduler.hpp"

#include <utility>

namespace armature {

void LockstepScheduler::assign(const ExecutorSpec& executor,
                               const std::vector<ComponentRunner*>& runners) {
  SimulatedPauses& pauses = pauses_.emplace_back(executor);
  for (ComponentRunner* runner : runners) {
    add(*runner, pauses, executor.period ? executor.period : runner->period());
  }
}

void LockstepScheduler::add(ComponentRunner& runner, SimulatedPauses& pauses,
                            std::optional<Duration> period) {
  entries_.push_back({.runner = &runner, .pauses = &pauses, .period = period});
  Entry& entry = entries_.back();
  runner.on_triggered([this, &entry] {
    entry.triggered = clock_->now();
    if (entry.is_triggered) return;
    entry.is_triggered = true;
    schedule({.time = clock_->now(), .place = entry.runner->place(), .activate = &entry});
  });
  if (period) {
    schedule({.time = {}, .place = runner.place(), .activate = &entry, .periodic = true});
  }
}

void LockstepScheduler::schedule(Event event) {
  event.sequence = next_sequence_++;
  events_.push(std::move(event));
}

void LockstepScheduler::publish(Topic& topic, SampleRef sample) {
  const Duration latency = running_ ? running_->runner->latency() : Duration{0};
  if (latency.count() == 0) {
    topic.send(std::move(sample), clock_->now());
    return;
  }
  schedule({.time = clock_->now() + latency,
            .place = running_->runner->place(),
            .topic = &topic,
            .sample = std::move(sample)});
}

void LockstepScheduler::handle(Event& event) {
  if (!event.activate) {
    event.topic->send(std::move(event.sample), event.time);
    return;
  }
  Entry& entry = *event.activate;
  if (const Time awake = entry.pauses->awake(event.time); awake > event.time) {
    event.time = awake;
    schedule(std::move(event));
    return;
  }
  if (event.periodic) {
    const auto missed = (event.time - event.due) / *entry.period;
    entry.runner->count_overruns(static_cast<std::uint64_t>(missed));
    schedule({.time = event.due + *entry.period * (missed + 1),
              .place = event.place,
              .activate = &entry,
              .periodic = true});
  } else {
    entry.is_triggered = false;
  }
  // Two events were held up together, and the first of them has done the work of both.
  if ((event.periodic ? event.due : entry.triggered) < entry.activated) return;
  entry.activated = event.time;
  running_ = &entry;
  entry.runner->activate(event.time, event.time - event.due);
  running_ = nullptr;
}

void LockstepScheduler::run(const std::function<bool()>& done) {
  while (!events_.empty() && !done()) {
    Event event = events_.top();
    events_.pop();
    clock_->set(event.time);
    handle(event);
  }
}

/// At once, between two activations: when everything rests already, not one more happens.
void LockstepScheduler::begin_stop() {
  for (Entry& entry : entries_) {
    entry.runner->request_stop();
    entry.runner->answer_stop_request(clock_->now());
  }
}

}  // namespace armature
