// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "armature/bus/qos.hpp"
#include "armature/messages/message_type.hpp"
#include "armature/values/real_time_mutex.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What was measured, and when, that a sample answers to.
struct Measurement {
  int source = -1;  // which of the deployment's measuring components; -1: of none
  Time at;          // the stamp of its sample
};

/// What travels beside a message.
struct SampleInfo {
  /// Deployment clock; of a writer that is not the deployment's own, when it arrived.
  Time published;
  std::uint32_t writer = 0;    // a number of its own in this process, once it is known
  std::uint64_t sequence = 0;  // counts from 1 per writer
  Measurement answers_to;      // from another process: nothing
  /// Samples of the same writer, in another process, that were sent after the one that was
  /// delivered before this, and did not arrive.
  std::uint64_t lost_before = 0;
};

class SamplePool;

/// A message owned by the bus; in flight it is shared and immutable.
struct SampleBlock {
  SamplePool* pool = nullptr;
  void* message = nullptr;
  SampleInfo info;
  std::atomic<int> references{0};
  SampleBlock* next_free = nullptr;
};

/// A counted reference to a sample. Copying is one atomic increment; the last one gives the block
/// back to its pool. Real-time safe.
class SampleRef {
 public:
  SampleRef() = default;
  explicit SampleRef(SampleBlock* block) : block_{block} { retain(); }
  SampleRef(const SampleRef& other) : block_{other.block_} { retain(); }
  SampleRef(SampleRef&& other) noexcept : block_{std::exchange(other.block_, nullptr)} {}
  SampleRef& operator=(SampleRef other) noexcept {
    std::swap(block_, other.block_);
    return *this;
  }
  ~SampleRef();

  explicit operator bool() const { return block_ != nullptr; }
  const void* message() const { return block_->message; }
  void* mutable_message() { return block_->message; }  // only before it is published
  const SampleInfo& info() const { return block_->info; }
  SampleInfo& mutable_info() { return block_->info; }

 private:
  void retain() {
    if (block_) block_->references.fetch_add(1, std::memory_order_relaxed);
  }
  SampleBlock* block_ = nullptr;
};

/// Which of a pool's free messages is used next.
enum class Reuse {
  in_turn,  // after one round each has the memory that its sequences need, so that a control thread
            // which suddenly needs more of them allocates nothing
  newest    // the one that came back last: a picture that is still in the processor's cache
};
Reuse reuse_for(QosProfile qos);

/// Preallocated messages of one type. When all are out it allocates another and counts that, so a
/// slow watcher costs memory, never data. Must outlive its samples: held by shared_ptr in the bus.
class SamplePool {
 public:
  SamplePool(const MessageType& type, std::size_t preallocated, Reuse reuse = Reuse::in_turn);
  ~SamplePool();
  SamplePool(const SamplePool&) = delete;
  SamplePool& operator=(const SamplePool&) = delete;

  const MessageType& type() const { return *type_; }
  /// A block with whatever content its last use left: overwrite every field. Real-time safe as
  /// long as a preallocated block is free.
  SampleRef loan();
  /// Copies `message` into every block that is not out, and into every one that is allocated later,
  /// so that its sequences and texts have their memory. Not real-time safe.
  void prepare(const void* message);
  /// Preallocates `more` blocks. Not real-time safe.
  void reserve(std::size_t more);
  /// Blocks allocated beyond the preallocated ones.
  std::size_t grown() const;

 private:
  friend class SampleRef;
  void give_back(SampleBlock* block);
  SampleBlock* allocate();
  void put_first(SampleBlock* block);
  void put_last(SampleBlock* block);

  const MessageType* type_;
  const Reuse reuse_;
  mutable RealTimeMutex mutex_;
  SampleBlock* first_free_ = nullptr;
  SampleBlock* last_free_ = nullptr;
  std::vector<std::unique_ptr<SampleBlock>> blocks_;
  std::size_t preallocated_;
  std::vector<std::byte> prototype_;  // encoded; empty: none
};

}  // namespace armature
