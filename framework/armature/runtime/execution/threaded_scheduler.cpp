// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/threaded_scheduler.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace armature {
namespace {

/// A deployment may be read, checked and replayed on any machine.
void check_cpu(const ExecutorSpec& executor) {
  const long count = sysconf(_SC_NPROCESSORS_CONF);
  if (!executor.cpu || *executor.cpu < count) return;
  throw std::runtime_error{fmt::format("executor '{}': 'cpu' is {}, this machine has 0 to {}",
                                       executor.name, *executor.cpu, count - 1)};
}

}  // namespace

void ThreadedScheduler::assign(const ExecutorSpec& executor,
                               const std::vector<ComponentRunner*>& runners) {
  check_cpu(executor);
  Executor& thread = executors_.emplace_back(executor, *clock_);
  for (ComponentRunner* runner : runners) thread.assign(*runner);
}

void ThreadedScheduler::run(const std::function<bool()>& done) {
  if (!std::exchange(started_, true)) {
    for (Executor& executor : executors_) executor.start(note_, on_late_);
  }
  while (!done()) std::this_thread::sleep_for(std::chrono::milliseconds{10});
}

void ThreadedScheduler::begin_stop() {
  for (Executor& executor : executors_) executor.begin_stop();
}

std::vector<const ComponentRunner*> ThreadedScheduler::stop(Duration timeout) {
  std::vector<Executor*> order;
  for (Executor& executor : executors_) order.push_back(&executor);
  std::sort(order.begin(), order.end(),
            [](const auto* a, const auto* b) { return a->first_place() < b->first_place(); });
  std::vector<const ComponentRunner*> hung;
  for (Executor* executor : order) {
    executor->request_stop();
    if (executor->join_for(timeout)) continue;
    if (const ComponentRunner* runner = executor->running()) {
      hung.push_back(runner);
    } else {
      executor->join();  // between two steps: it only has to get its turn
    }
  }
  return hung;
}

}  // namespace armature
