// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "armature/runtime/execution/real_time_thread.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

/// The shortest delay that is told: the limit of motion (max_lateness_s).
constexpr Duration kLate = std::chrono::milliseconds{kSanitized ? 500 : 100};

}  // namespace

Executor::Executor(ExecutorSpec spec, const Clock& clock)
    : spec_{std::move(spec)}, clock_{&clock} {}

Executor::~Executor() {
  request_stop();
  join();
}

void Executor::assign(ComponentRunner& runner) {
  triggers_.push_back(std::make_unique<std::atomic<std::int64_t>>(kNever));
  std::atomic<std::int64_t>* triggered_ns = triggers_.back().get();
  entries_.push_back({.runner = &runner,
                      .period = spec_.period ? spec_.period : runner.period(),
                      .triggered_ns = triggered_ns});
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.runner->place() < b.runner->place(); });
  runner.set_executor(spec_.name, times_);
  runner.on_triggered([this, triggered_ns] {
    std::int64_t never = kNever;
    triggered_ns->compare_exchange_strong(never, clock_->now().ns, std::memory_order_acq_rel);
    wake_.notify();
  });
}

int Executor::first_place() const {
  return entries_.empty() ? 0 : entries_.front().runner->place();
}

bool Executor::has_period() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) { return entry.period.has_value(); });
}

void Executor::start(const std::function<void(const std::string&)>& note,
                     std::function<void(const std::string&)> on_late) {
  on_late_ = std::move(on_late);
  if (spec_.lock_memory) {
    if (const std::string refusal = lock_process_memory(); !refusal.empty()) {
      note(fmt::format("executor '{}' runs without locked memory: {}", spec_.name, refusal));
    }
  }
  std::promise<std::vector<std::string>> prepared;
  std::future<std::vector<std::string>> notes = prepared.get_future();
  thread_ = std::thread{[this, prepared = std::move(prepared)]() mutable {
    const CrashStack crash_stack;
    prepared.set_value(prepare_thread({.name = spec_.name,
                                       .priority = spec_.priority,
                                       .cpu = spec_.cpu,
                                       .has_period = has_period()}));
    for (Entry& entry : entries_) entry.next_release = clock_->now();
    loop();
    end_.set_value();
  }};
  for (const std::string& refusal : notes.get()) {
    note(fmt::format("executor '{}' {}", spec_.name, refusal));
  }
}

void Executor::begin_stop() {
  for (const Entry& entry : entries_) entry.runner->request_stop();
  wake_.notify();
}

void Executor::request_stop() {
  stopping_ = true;
  wake_.notify();
}

void Executor::join() {
  if (thread_.joinable()) thread_.join();
}

bool Executor::join_for(Duration timeout) {
  if (!thread_.joinable()) return true;
  if (ended_.wait_for(timeout) != std::future_status::ready) return false;
  thread_.join();
  return true;
}

std::optional<Time> Executor::next_release() const {
  std::optional<Time> next;
  for (const Entry& entry : entries_) {
    if (entry.period && (!next || entry.next_release < *next)) next = entry.next_release;
  }
  return next;
}

/// When `entry` should have been activated, if that is not in the future.
std::optional<Time> Executor::take_release(Entry& entry, Time now) {
  std::optional<Time> release;
  const std::int64_t triggered = entry.triggered_ns->exchange(kNever, std::memory_order_acq_rel);
  if (triggered != kNever) release = Time{triggered};
  if (entry.period && now >= entry.next_release) {
    if (!release || entry.next_release < *release) release = entry.next_release;
    const auto missed = (now - entry.next_release) / *entry.period;
    entry.runner->count_overruns(static_cast<std::uint64_t>(missed));
    entry.next_release = entry.next_release + *entry.period * (missed + 1);
  }
  return release;
}

void Executor::step(Entry& entry, Time now, Time release) {
  entry.runner->activate(now, now - release);
  // After the step: it is late enough.
  if (entry.period && now - release >= kLate) tell_late(entry, now, release);
  entry.stepped_until = clock_->now();
  entry.step_took = entry.stepped_until - now;
}

/// Tells which step kept `late` from its release, its own or another one's, if one took at least
/// half of that time. A machine that is busy with other things is not told here.
void Executor::tell_late(const Entry& late, Time now, Time release) {
  const Entry* slow = nullptr;
  for (const Entry& entry : entries_) {
    if (entry.stepped_until <= release || 2 * entry.step_took < now - release) continue;
    if (!slow || slow->step_took < entry.step_took) slow = &entry;
  }
  if (!slow || !on_late_ || !late_notes_.due(now)) return;
  on_late_(fmt::format("'{}' was activated {:.2f} s late: {} took {:.2f} s", late.runner->name(),
                       to_seconds(now - release),
                       slow == &late ? "its own step before"
                                     : fmt::format("the step of '{}', which shares executor '{}',",
                                                   slow->runner->name(), spec_.name),
                       to_seconds(slow->step_took)));
}

void Executor::activate_due() {
  std::optional<Time> begin;
  for (Entry& entry : entries_) {
    if (stopping_) break;
    const Time now = clock_->now();
    running_.store(entry.runner, std::memory_order_release);
    entry.runner->answer_stop_request(now);
    if (const auto release = take_release(entry, now)) {
      if (!begin) {
        begin = now;
        times_.lateness.add(now - *release);
      }
      step(entry, now, *release);
    }
    running_.store(nullptr, std::memory_order_release);
  }
  if (begin) times_.duration.add(clock_->now() - *begin);
}

void Executor::loop() {
  while (!stopping_) {
    activate_due();
    if (const auto next = next_release()) {
      const auto from = std::chrono::steady_clock::now();  // before the other clock: never too late
      wake_.wait_until(from + std::max(Duration{0}, *next - clock_->now()));
    } else {
      wake_.wait();
    }
  }
}

}  // namespace armature
