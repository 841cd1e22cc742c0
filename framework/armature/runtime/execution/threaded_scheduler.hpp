// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>

#include "armature/runtime/execution/executor.hpp"
#include "armature/runtime/execution/scheduler.hpp"

namespace armature ARMATURE_EXPORT {

/// The system clock's scheduler: every executor is a thread, samples are handed over at once.
class ThreadedScheduler final : public Scheduler {
 public:
  using Note = std::function<void(const std::string&)>;
  /// Hands both to Executor::start().
  ThreadedScheduler(const Clock& clock, Note note, Note on_late = {})
      : clock_{&clock}, note_{std::move(note)}, on_late_{std::move(on_late)} {}

  void assign(const ExecutorSpec& executor, const std::vector<ComponentRunner*>& runners) override;
  void run(const std::function<bool()>& done) override;
  void begin_stop() override;
  std::vector<const ComponentRunner*> stop(Duration timeout) override;
  void publish(Topic& topic, SampleRef sample) override {
    topic.send(std::move(sample), clock_->now());
  }

 private:
  const Clock* clock_;
  Note note_, on_late_;
  std::deque<Executor> executors_;
  bool started_ = false;
};

}  // namespace armature
