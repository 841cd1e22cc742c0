// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "armature/values/real_time_mutex.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A thread of a component's own, for a device whose calls wait (Setup::driver_thread). The runtime
/// starts it when the run begins and ends it after the component's last step. No signal interrupts
/// its calls. An exception out of it is the component's fault.
class DriverThread {
 public:
  /// What the runtime gives it. All are called on the thread.
  struct Links {
    std::function<Time()> now;   // the deployment's clock
    std::function<void()> wake;  // asks for an activation of the component
    std::function<void(const std::string& what)> fault;
  };

  explicit DriverThread(std::function<void()> body);
  virtual ~DriverThread();
  DriverThread(const DriverThread&) = delete;
  DriverThread& operator=(const DriverThread&) = delete;

  // What its body calls.
  /// True when the run ends: the body returns then, at the latest within 1 s.
  bool stopping() const { return stopping_.load(std::memory_order_acquire); }
  /// The deployment's clock, for the stamp of what has just been read.
  Time now() const { return links_.now(); }
  /// Waits; returns false, at once, when the run ends.
  bool sleep_for(Duration duration) const;
  /// A file descriptor that becomes readable when the run ends, for poll() beside the device's own.
  int stop_descriptor() const { return stop_descriptor_; }

  // What the runtime calls.
  /// `component` names the thread, and outlives it.
  void start(const std::string& component, Links links);
  void request_stop();
  /// False when the body has not returned until `end`.
  bool join_until(std::chrono::steady_clock::time_point end);
  /// How much was lost because the component did not take it in time. Any thread.
  virtual std::uint64_t dropped() const = 0;

 protected:
  void wake() const { links_.wake(); }
  /// Waits for the end of the body, which may use what a derived class has.
  void join();

 private:
  void run(const std::string& component);

  std::function<void()> body_;
  Links links_;
  int stop_descriptor_;
  std::atomic<bool> stopping_{false};
  std::promise<void> end_;
  std::future<void> ended_ = end_.get_future();
  std::thread thread_;
};

/// A driver thread, and what it has read: a bounded queue from there to the component's `step`.
/// Neither side ever waits for the other.
template <class Sample>
class DriverQueue final : public DriverThread {
 public:
  struct Stamped {
    Time stamp;  // when it was so, as the driver thread says
    Sample sample;
  };

  /// `capacity` is how many samples wait at most.
  DriverQueue(std::size_t capacity, std::function<void()> body)
      : DriverThread{std::move(body)}, places_(capacity == 0 ? 1 : capacity) {}
  ~DriverQueue() override { join(); }

  /// On the driver thread: hands a sample over and activates the component. When the queue is full
  /// the oldest sample is dropped, and counted.
  void push(Time stamp, Sample sample) {
    std::optional<Stamped> added{Stamped{stamp, std::move(sample)}};
    {
      const std::scoped_lock lock{mutex_};
      // What was there, if anything, is destroyed after the lock is gone.
      std::swap(places_[(first_ + count_) % places_.size()], added);
      if (count_ < places_.size()) {
        ++count_;
      } else {
        first_ = (first_ + 1) % places_.size();
        ++dropped_;
      }
    }
    wake();
  }

  /// In `step`: the oldest sample that waits. Real-time safe when moving a sample is.
  std::optional<Stamped> take() {
    const std::scoped_lock lock{mutex_};
    if (count_ == 0) return std::nullopt;
    std::optional<Stamped> taken = std::exchange(places_[first_], std::nullopt);
    first_ = (first_ + 1) % places_.size();
    --count_;
    return taken;
  }

  std::uint64_t dropped() const override {
    const std::scoped_lock lock{mutex_};
    return dropped_;
  }

 private:
  mutable RealTimeMutex mutex_;
  std::vector<std::optional<Stamped>> places_;  // a ring
  std::size_t first_ = 0, count_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace armature
