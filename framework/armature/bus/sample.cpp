// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/sample.hpp"

#include <mutex>

namespace armature {

SampleRef::~SampleRef() {
  // acq_rel: whoever reuses the block must see every read of the holders before.
  if (block_ && block_->references.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    block_->pool->give_back(block_);
  }
}

Reuse reuse_for(QosProfile qos) {
  return qos == QosProfile::sensor ? Reuse::newest : Reuse::in_turn;
}

SamplePool::SamplePool(const MessageType& type, std::size_t preallocated, Reuse reuse)
    : type_{&type}, reuse_{reuse}, preallocated_{preallocated} {
  for (std::size_t i = 0; i < preallocated; ++i) {
    put_last(allocate());
  }
}

SamplePool::~SamplePool() {
  for (const auto& block : blocks_) type_->destroy(block->message);
}

SampleBlock* SamplePool::allocate() {
  auto block = std::make_unique<SampleBlock>();
  block->pool = this;
  block->message = type_->create();
  if (!prototype_.empty()) type_->decode(prototype_, block->message);
  blocks_.push_back(std::move(block));
  return blocks_.back().get();
}

SampleRef SamplePool::loan() {
  const std::scoped_lock lock{mutex_};
  if (!first_free_) return SampleRef{allocate()};
  SampleBlock* block = std::exchange(first_free_, first_free_->next_free);
  if (!first_free_) last_free_ = nullptr;
  return SampleRef{block};
}

void SamplePool::put_first(SampleBlock* block) {
  block->next_free = std::exchange(first_free_, block);
  if (!last_free_) last_free_ = block;
}

void SamplePool::put_last(SampleBlock* block) {
  block->next_free = nullptr;
  SampleBlock* before = std::exchange(last_free_, block);
  (before ? before->next_free : first_free_) = block;
}

void SamplePool::give_back(SampleBlock* block) {
  const std::scoped_lock lock{mutex_};
  reuse_ == Reuse::newest ? put_first(block) : put_last(block);
}

void SamplePool::prepare(const void* message) {
  const std::scoped_lock lock{mutex_};
  prototype_.clear();
  type_->encode(message, prototype_);
  for (SampleBlock* block = first_free_; block; block = block->next_free) {
    type_->decode(prototype_, block->message);
  }
}

void SamplePool::reserve(std::size_t more) {
  const std::scoped_lock lock{mutex_};
  for (std::size_t i = 0; i < more; ++i) put_last(allocate());
  preallocated_ += more;
}

std::size_t SamplePool::grown() const {
  const std::scoped_lock lock{mutex_};
  return blocks_.size() - preallocated_;
}

}  // namespace armature
