// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <semaphore.h>
#include <time.h>

#include <atomic>
#include <cerrno>
#include <chrono>

namespace armature ARMATURE_EXPORT {

/// Wakes one waiting thread, from any thread and without a lock: nobody who wakes a control thread
/// can delay it, and no control thread waits for whom it wakes. (A condition variable of glibc has
/// a lock of its own, without priority inheritance.) Calls before the wait are remembered, as one.
/// Real-time safe.
class WakeUp {
 public:
  WakeUp() { sem_init(&semaphore_, 0, 0); }
  ~WakeUp() { sem_destroy(&semaphore_); }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void notify() {
    if (!pending_.exchange(true, std::memory_order_acq_rel)) sem_post(&semaphore_);
  }

  /// Waits until notify() is called; only one thread may wait.
  void wait() {
    while (sem_wait(&semaphore_) != 0 && errno == EINTR) {
    }
    pending_.exchange(false, std::memory_order_acq_rel);
  }

  /// Waits until notify() is called or the monotonic clock shows `end`; false: the time was over.
  bool wait_until(std::chrono::steady_clock::time_point end) {
    const auto ns = std::chrono::nanoseconds{end.time_since_epoch()}.count();
    constexpr long kSecond = 1'000'000'000;
    const timespec at{.tv_sec = ns / kSecond, .tv_nsec = ns % kSecond};
    int result = 0;
    do {
      result = sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &at);
    } while (result != 0 && errno == EINTR);
    if (result == 0) pending_.exchange(false, std::memory_order_acq_rel);
    return result == 0;
  }

 private:
  sem_t semaphore_;
  std::atomic<bool> pending_{false};
};

}  // namespace armature
