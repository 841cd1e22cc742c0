// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/egress.hpp"

#include <pthread.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace armature {

Egress::Egress() : thread_{[this] { run(); }} {}

Egress::~Egress() {
  {
    const std::scoped_lock lock{mutex_};
    stop_ = true;
  }
  work_.notify();
  thread_.join();
}

std::unique_ptr<Egress::Queue> Egress::open(std::size_t depth,
                                            std::function<void(const SampleRef&)> send) {
  auto queue = std::make_unique<Queue>(*this, depth, std::move(send));
  const std::scoped_lock lock{mutex_};
  queues_.push_back(queue.get());
  return queue;
}

Egress::Queue* Egress::next_waiting() {
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    const std::size_t index = (turn_ + i) % queues_.size();
    if (queues_[index]->size_ > 0) {
      turn_ = index + 1;
      return queues_[index];
    }
  }
  return nullptr;
}

void Egress::run() {
  pthread_setname_np(pthread_self(), "dds-egress");
  std::unique_lock lock{mutex_};
  while (!stop_) {
    Queue* queue = next_waiting();
    if (!queue) {
      lock.unlock();
      work_.wait();
      lock.lock();
      continue;
    }
    sending_ = queue;
    SampleRef sample = queue->pop();
    lock.unlock();
    queue->send_(sample);
    sample = SampleRef{};
    lock.lock();
    sending_ = nullptr;
    if (waiting_ > 0) sent_.notify_all();
  }
}

Egress::Queue::Queue(Egress& egress, std::size_t depth, std::function<void(const SampleRef&)> send)
    : egress_{egress}, send_{std::move(send)}, ring_(depth) {}

Egress::Queue::~Queue() {
  std::unique_lock lock{egress_.mutex_};
  std::erase(egress_.queues_, this);
  ++egress_.waiting_;
  egress_.sent_.wait(lock, [this] { return egress_.sending_ != this; });
  --egress_.waiting_;
  lock.unlock();
  while (size_ > 0) send_(pop());  // nobody else knows this queue any more
}

void Egress::Queue::offer(const SampleRef& sample) {
  SampleRef oldest;  // given back to its pool outside the lock
  {
    const std::scoped_lock lock{egress_.mutex_};
    if (size_ == ring_.size()) {
      oldest = pop();
      ++dropped_;
    }
    ring_[(first_ + size_) % ring_.size()] = sample;
    ++size_;
  }
  egress_.work_.notify();
}

std::uint64_t Egress::Queue::dropped() const {
  const std::scoped_lock lock{egress_.mutex_};
  return dropped_;
}

bool Egress::Queue::drained(Duration timeout) {
  std::unique_lock lock{egress_.mutex_};
  ++egress_.waiting_;
  const bool all_sent = egress_.sent_.wait_for(
      lock, timeout, [this] { return size_ == 0 && egress_.sending_ != this; });
  --egress_.waiting_;
  return all_sent;
}

SampleRef Egress::Queue::pop() {
  SampleRef sample = std::move(ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  --size_;
  return sample;
}

}  // namespace armature
