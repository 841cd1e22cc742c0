// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/component/activation_tap.hpp"
#include "armature/runtime/execution/clock.hpp"

namespace armature ARMATURE_EXPORT {

/// Keeps what one component's calls read and wrote until a recorder takes it: a ring that one
/// thread fills and one empties, without a lock. Calls are kept whole or not at all. Samples are
/// held, not copied.
class ActivationLog final : public ActivationTap {
 public:
  /// A part of a call. Its parts follow each other, from `begin` to `end`.
  struct Entry {
    enum class Kind : std::uint8_t { begin, lost, read, answer, published, failed, end };
    Kind kind = Kind::begin;
    ComponentCall call = ComponentCall::step;  // begin
    bool answer = false;                       // of has_subscribers
    std::int32_t input = 0;                    // read
    std::int64_t number = 0;  // begin: the component's now [ns]; published: when, on the clock;
                              // lost: how many calls were not kept before, if any
    SampleRef sample;         // read, published
  };

  /// `capacity` is a power of two. A full ring loses the call, or with `waits` the component waits
  /// until there is room, which is for the simulated clock. A call with more parts than it has room
  /// for is lost all the same. `clock` outlives it.
  ActivationLog(std::size_t capacity, const Clock& clock, bool waits);

  void begin(ComponentCall call, Time now) override;
  void end(std::string_view failure) override;
  void read(int input, std::span<const SampleRef> samples) override;
  bool has_subscribers(bool truly) override;
  void published(const SampleRef& sample) override;

  /// The next part of a call that has ended. Of the recorder's thread.
  std::optional<Entry> take();
  /// What came out of the call that failed; after its `failed` was taken.
  const std::string& failure() const { return failure_; }
  /// Whether a call has begun and not ended. Any thread.
  bool is_called() const { return is_called_.load(std::memory_order_acquire); }
  /// Calls that were not kept. Any thread.
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }
  /// Messages that these had published. Any thread.
  std::uint64_t lost_samples() const { return lost_samples_.load(std::memory_order_relaxed); }
  /// Samples that came from other threads than the one that called the component; they belong to no
  /// call and are not kept. Any thread.
  std::uint64_t strays() const { return strays_.load(std::memory_order_relaxed); }

 private:
  void put(Entry entry);
  void wait_for_room();
  bool has_room();
  /// Whether this thread is the one that calls the component.
  bool is_of_call() const;
  Entry& at(std::uint64_t position) { return ring_[position & (ring_.size() - 1)]; }

  const Clock* clock_;
  const bool waits_;
  std::vector<Entry> ring_;
  std::atomic<std::uint64_t> taken_{0}, ended_{0};  // positions: what is between them can be taken
  std::uint64_t next_ = 0;                          // of the running call
  std::uint64_t known_taken_ = 0;                   // as its thread has seen it last
  std::uint64_t published_ = 0;                     // by the running call
  bool is_too_long_ = false;                        // the running call does not fit
  std::string failure_;
  std::atomic<bool> is_called_{false};
  std::atomic<pthread_t> thread_{};
  std::atomic<std::uint64_t> lost_{0}, lost_samples_{0}, strays_{0};
};

}  // namespace armature
