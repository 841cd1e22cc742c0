// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/ports.hpp"

namespace armature::bench {

inline constexpr std::size_t kJoints = 7;

/// What a control step may be: some trigonometry into the joint state of an arm; 1 to 2 us.
void tiny_work(std::uint64_t step, msg::JointState& state);

/// What the operating system and malloc have counted for a thread.
struct ThreadCounts {
  std::uint64_t page_faults = 0, allocations = 0;
};
/// Of the calling thread; no allocations where a sanitizer has a malloc of its own.
ThreadCounts counts_of_this_thread();

/// What a measured thread is asked to do between two of its steps, and what it answers. Any thread
/// asks; real-time safe for the one that answers.
class Requests {
 public:
  void move(int cpu) { cpu_.store(cpu); }
  /// Waits until the thread has told its counts; false: it did not for a second.
  bool ask(ThreadCounts& counts);
  /// Called by the measured thread in every step.
  void answer();

 private:
  static constexpr int kNone = -1;
  std::atomic<int> cpu_{kNone};
  std::atomic<bool> requested_{false};
  std::atomic<std::uint64_t> page_faults_{0}, allocations_{0};
};

/// The component that the bench runs: the tiny work, published as a joint state.
class LoopComponent final : public Component {
 public:
  static const std::string_view kPlugin;  // its plugin.yaml

  explicit LoopComponent(Setup& setup);
  void step(Time now) override;
  Requests& requests() { return requests_; }

 private:
  Output<msg::JointState> state_;
  std::uint64_t steps_ = 0;
  Requests requests_;
};

}  // namespace armature::bench
