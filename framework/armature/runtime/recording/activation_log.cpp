// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/recording/activation_log.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace armature {

ActivationLog::ActivationLog(std::size_t capacity, const Clock& clock, bool waits)
    : clock_{&clock}, waits_{waits}, ring_(capacity) {}

void ActivationLog::begin(ComponentCall call, Time now) {
  thread_.store(pthread_self(), std::memory_order_relaxed);
  is_called_.store(true, std::memory_order_release);
  next_ = ended_.load(std::memory_order_relaxed);
  is_too_long_ = false;
  published_ = 0;
  put({.kind = Entry::Kind::begin, .call = call, .number = now.ns});
  if (const std::uint64_t before = lost(); before > 0) {
    put({.kind = Entry::Kind::lost, .number = static_cast<std::int64_t>(before)});
  }
}

void ActivationLog::end(std::string_view failure) {
  if (!failure.empty()) {
    failure_ = failure;
    put({.kind = Entry::Kind::failed});
  }
  put({.kind = Entry::Kind::end});
  is_called_.store(false, std::memory_order_release);
  if (is_too_long_) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    lost_samples_.fetch_add(published_, std::memory_order_relaxed);
    for (auto position = ended_.load(std::memory_order_relaxed); position < next_; ++position) {
      at(position).sample = {};
    }
    return;
  }
  ended_.store(next_, std::memory_order_release);
}

void ActivationLog::read(int input, std::span<const SampleRef> samples) {
  for (const SampleRef& sample : samples) {
    put({.kind = Entry::Kind::read, .input = input, .sample = sample});
  }
}

bool ActivationLog::has_subscribers(bool truly) {
  if (is_of_call()) put({.kind = Entry::Kind::answer, .answer = truly});
  return truly;
}

bool ActivationLog::is_of_call() const {
  return is_called() && pthread_equal(thread_.load(std::memory_order_relaxed), pthread_self()) != 0;
}

void ActivationLog::published(const SampleRef& sample) {
  if (is_of_call()) {
    ++published_;
    put({.kind = Entry::Kind::published, .number = clock_->now().ns, .sample = sample});
  } else {
    strays_.fetch_add(1, std::memory_order_relaxed);
  }
}

bool ActivationLog::has_room() {
  if (next_ - known_taken_ < ring_.size()) return true;
  known_taken_ = taken_.load(std::memory_order_acquire);
  return next_ - known_taken_ < ring_.size();
}

/// What has ended goes as soon as the recorder comes by; the running call itself must fit.
void ActivationLog::wait_for_room() {
  while (!has_room() && next_ - ended_.load(std::memory_order_relaxed) < ring_.size()) {
    std::this_thread::sleep_for(std::chrono::microseconds{50});
  }
}

void ActivationLog::put(Entry entry) {
  if (is_too_long_) return;
  if (waits_) wait_for_room();
  if (!has_room()) {
    is_too_long_ = true;
    return;
  }
  at(next_++) = std::move(entry);
}

std::optional<ActivationLog::Entry> ActivationLog::take() {
  const std::uint64_t position = taken_.load(std::memory_order_relaxed);
  if (position == ended_.load(std::memory_order_acquire)) return std::nullopt;
  Entry entry = std::move(at(position));
  taken_.store(position + 1, std::memory_order_release);
  return entry;
}

}  // namespace armature
