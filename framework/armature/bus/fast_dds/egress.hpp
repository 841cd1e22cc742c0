// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "armature/bus/sample.hpp"
#include "armature/values/real_time_mutex.hpp"
#include "armature/values/time.hpp"
#include "armature/values/wake_up.hpp"

namespace armature ARMATURE_EXPORT {

/// The thread that encodes and writes for all topics of the process, so that no watcher ever runs
/// on a publisher's thread. One bounded queue per topic; the topics take turns.
class Egress {
 public:
  class Queue;

  Egress();
  /// Every queue must be gone.
  ~Egress();
  Egress(const Egress&) = delete;
  Egress& operator=(const Egress&) = delete;

  /// A queue of `depth` samples; `send` is called on the egress thread, one sample at a time.
  std::unique_ptr<Queue> open(std::size_t depth, std::function<void(const SampleRef&)> send);

 private:
  void run();
  Queue* next_waiting();

  RealTimeMutex mutex_;
  WakeUp work_;                       // something waits, or the end
  std::condition_variable_any sent_;  // a sample, while somebody waits for that
  int waiting_ = 0;                   // who does
  std::vector<Queue*> queues_;
  std::size_t turn_ = 0;
  Queue* sending_ = nullptr;
  bool stop_ = false;
  std::thread thread_;
};

/// Its end for one topic.
class Egress::Queue {
 public:
  Queue(Egress& egress, std::size_t depth, std::function<void(const SampleRef&)> send);
  /// Sends what waits (on this thread), then leaves; afterwards nothing of it is in use.
  ~Queue();
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Drops the oldest waiting sample when the queue is full. Real-time safe: a short lock that no
  /// one holds while sending.
  void offer(const SampleRef& sample);
  std::uint64_t dropped() const;
  /// Waits until all that was offered is sent, at most for `timeout`; false then.
  bool drained(Duration timeout);

 private:
  friend class Egress;
  SampleRef pop();

  Egress& egress_;
  std::function<void(const SampleRef&)> send_;
  std::vector<SampleRef> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace armature
