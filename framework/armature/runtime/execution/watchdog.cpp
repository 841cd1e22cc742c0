// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/real_time_thread.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

/// How often to look: often enough for the shortest limit.
Duration tick_for(const std::vector<Watchdog::Watched>& watched) {
  constexpr Duration kShortest = std::chrono::milliseconds{1};
  Duration tick = std::chrono::milliseconds{100};
  for (const auto& one : watched) tick = std::min(tick, one.max_step / 4);
  return std::max(tick, kShortest);
}

}  // namespace

Duration max_step_of(const std::optional<Duration>& given, const std::optional<Duration>& period) {
  constexpr int kSlowdown = kSanitized ? 5 : 1;
  constexpr Duration kMin = std::chrono::milliseconds{500}, kTriggered = std::chrono::seconds{2};
  if (given) return *given * kSlowdown;
  return (period ? std::max(3 * *period, kMin) : kTriggered) * kSlowdown;
}

std::optional<Duration> declared_max_step(const ComponentConfig& component,
                                          const DeploymentConfig& deployment) {
  constexpr int kLockstepTimeout = 10;
  const auto& units = component.manifest->units;
  const auto unit = std::ranges::find(units, component.unit, &UnitSpec::name);
  const auto& given = unit == units.end() ? component.manifest->max_step : unit->max_step;
  if (deployment.simulated) return kLockstepTimeout * max_step_of(given, std::nullopt);
  const auto executor =
      std::ranges::find(deployment.executors, component.executor, &ExecutorSpec::name);
  if (!given && !executor->period) return std::nullopt;
  return max_step_of(given, executor->period);
}

Watchdog::Watchdog(std::vector<Watched> watched, int priority,
                   std::function<void(const std::string&)> note)
    : watched_{std::move(watched)},
      seen_(watched_.size()),
      tick_{tick_for(watched_)},
      priority_{priority},
      note_{std::move(note)},
      thread_{[this] { loop(); }} {}

Watchdog::~Watchdog() {
  end_.notify();
  thread_.join();
}

std::string Watchdog::verdict() const {
  const std::scoped_lock lock{mutex_};
  return verdict_;
}

void Watchdog::loop() {
  using Steady = std::chrono::steady_clock;
  // What the system does not allow it does not allow the executors either, who tell it.
  prepare_thread({.name = "watchdog", .priority = priority_, .has_period = false});
  auto before = Steady::now();
  while (!end_.wait_until(before + tick_)) {
    const auto now = Steady::now();
    const Duration elapsed = std::min<Duration>(now - before, 2 * tick_);
    before = now;
    for (std::size_t i = 0; i < watched_.size(); ++i) look(watched_[i], seen_[i], elapsed);
  }
}

void Watchdog::look(const Watched& watched, Seen& seen, Duration elapsed) {
  const std::int64_t since_ns = watched.runner->running_since_ns();
  const bool same = since_ns != 0 && since_ns == seen.since_ns;
  if (!same) {
    if (seen.observed >= watched.max_step && note_) {
      note_(fmt::format("the step of '{}' has returned", watched.runner->name()));
    }
    watched.runner->set_stalled({});
    seen = {.since_ns = since_ns, .observed = {}};
    return;
  }
  const bool hung_before = seen.observed >= watched.max_step;
  seen.observed += elapsed;
  if (seen.observed < watched.max_step) return;
  watched.runner->set_stalled(seen.observed);
  if (!hung_before) tell_hung(watched, seen.observed);
}

void Watchdog::tell_hung(const Watched& watched, Duration observed) {
  const std::string text = fmt::format("the step of '{}' has not returned for {:.2f} s",
                                       watched.runner->name(), to_seconds(observed));
  if (watched.stops_run) {
    const std::scoped_lock lock{mutex_};
    if (verdict_.empty()) verdict_ = text;
  }
  if (note_) note_(text);
}

}  // namespace armature
