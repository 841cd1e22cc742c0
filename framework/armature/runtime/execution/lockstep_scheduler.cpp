// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/lockstep_scheduler.hpp"

#include <utility>

namespace armature {

void LockstepScheduler::assign(const ExecutorSpec& executor,
                               const std::vector<ComponentRunner*>& runners) {
  for (ComponentRunner* runner : runners) {
    add(*runner, executor.period ? executor.period : runner->period());
  }
}

void LockstepScheduler::add(ComponentRunner& runner, std::optional<Duration> period) {
  entries_.push_back({&runner, period, std::nullopt});
  Entry& entry = entries_.back();
  runner.on_triggered([this, &entry] {
    const Time now = clock_->now();
    if (entry.triggered_at == now) return;
    entry.triggered_at = now;
    schedule({.time = now, .place = entry.runner->place(), .activate = &entry});
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
  if (event.periodic) {
    schedule({.time = event.time + *entry.period,
              .place = event.place,
              .activate = &entry,
              .periodic = true});
  } else {
    entry.triggered_at.reset();
  }
  running_ = &entry;
  entry.runner->activate(event.time);
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
