// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/executor.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cstring>

namespace armature {

Executor::Executor(ExecutorSpec spec, const Clock& clock)
    : spec_{std::move(spec)}, clock_{&clock} {}

Executor::~Executor() {
  request_stop();
  join();
}

void Executor::assign(Unit& unit) {
  flags_.push_back(std::make_unique<std::atomic<bool>>(false));
  std::atomic<bool>* triggered = flags_.back().get();
  entries_.push_back({.unit = &unit,
                      .period = spec_.period ? spec_.period : unit.period(),
                      .next_release = {},
                      .triggered = triggered});
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.unit->place() < b.unit->place(); });
  unit.on_triggered([this, triggered] {
    triggered->store(true, std::memory_order_release);
    {
      const std::scoped_lock lock{mutex_};
      woken_ = true;
    }
    wake_.notify_one();
  });
}

int Executor::first_place() const { return entries_.empty() ? 0 : entries_.front().unit->place(); }

void Executor::start(const std::function<void(const std::string&)>& note) {
  for (Entry& entry : entries_) entry.next_release = clock_->now();
  thread_ = std::thread{[this] { loop(); }};
  pthread_setname_np(thread_.native_handle(), spec_.name.substr(0, 15).c_str());
  if (spec_.priority > 0) {
    const sched_param parameters{.sched_priority = spec_.priority};
    if (const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters)) {
      note(fmt::format("executor '{}' runs without priority {}: {}", spec_.name, spec_.priority,
                       std::strerror(error)));
    }
  }
  if (spec_.cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(*spec_.cpu), &set);
    if (const int error = pthread_setaffinity_np(thread_.native_handle(), sizeof set, &set)) {
      note(fmt::format("executor '{}' is not pinned to cpu {}: {}", spec_.name, *spec_.cpu,
                       std::strerror(error)));
    }
  }
}

void Executor::request_stop() {
  stopping_ = true;
  {
    const std::scoped_lock lock{mutex_};
    woken_ = true;
  }
  wake_.notify_one();
}

void Executor::join() {
  if (thread_.joinable()) thread_.join();
}

std::optional<Time> Executor::next_release() const {
  std::optional<Time> next;
  for (const Entry& entry : entries_) {
    if (entry.period && (!next || entry.next_release < *next)) next = entry.next_release;
  }
  return next;
}

void Executor::activate_due() {
  for (Entry& entry : entries_) {
    if (stopping_) return;
    const Time now = clock_->now();
    bool due = entry.triggered->exchange(false, std::memory_order_acq_rel);
    if (entry.period && now >= entry.next_release) {
      due = true;
      const auto missed = (now - entry.next_release) / *entry.period;
      entry.unit->count_overruns(static_cast<std::uint64_t>(missed));
      entry.next_release = entry.next_release + *entry.period * (missed + 1);
    }
    if (due) entry.unit->activate(now);
  }
}

void Executor::loop() {
  while (!stopping_) {
    activate_due();
    std::unique_lock lock{mutex_};
    const auto woken = [this] { return woken_; };
    if (const auto next = next_release()) {
      const auto wait = std::max(Duration{0}, *next - clock_->now());
      wake_.wait_until(lock, std::chrono::steady_clock::now() + wait, woken);
    } else {
      wake_.wait(lock, woken);
    }
    woken_ = false;
  }
}

}  // namespace armature
