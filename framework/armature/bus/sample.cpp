// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/sample.hpp"

namespace armature {

SampleRef::~SampleRef() {
  // acq_rel: whoever reuses the block must see every read of the holders before.
  if (block_ && block_->references.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    block_->pool->give_back(block_);
  }
}

SamplePool::SamplePool(const MessageType& type, std::size_t preallocated)
    : type_{&type}, preallocated_{preallocated} {
  for (std::size_t i = 0; i < preallocated; ++i) {
    SampleBlock* block = allocate();
    block->next_free = std::exchange(free_, block);
  }
}

SamplePool::~SamplePool() {
  for (const auto& block : blocks_) type_->destroy(block->message);
}

SampleBlock* SamplePool::allocate() {
  auto block = std::make_unique<SampleBlock>();
  block->pool = this;
  block->message = type_->create();
  blocks_.push_back(std::move(block));
  return blocks_.back().get();
}

SampleRef SamplePool::loan() {
  const std::scoped_lock lock{mutex_};
  SampleBlock* block = free_;
  if (block) {
    free_ = block->next_free;
  } else {
    block = allocate();
  }
  return SampleRef{block};
}

void SamplePool::give_back(SampleBlock* block) {
  const std::scoped_lock lock{mutex_};
  block->next_free = std::exchange(free_, block);
}

std::size_t SamplePool::grown() const {
  const std::scoped_lock lock{mutex_};
  return blocks_.size() - preallocated_;
}

}  // namespace armature
