// SPDX-License-Identifier: Apache-2.0
// A run of a deployment: waiting for the others, running, stopping, ended.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"

namespace armature {
namespace {

std::string fault_text(const ComponentRunner& unit) {
  return unit.name() + ": " + unit.status().reason;
}

}  // namespace

void Deployment::run(RunWatch& watch) {
  if (await_start(watch)) {
    const std::string cause = run_until_stop(watch);
    stopping_ = true;
    watch.stopping(cause);
    come_to_rest(watch);
  }
  watch.ending();
  end();
}

bool Deployment::await_start(RunWatch& watch) {
  constexpr std::chrono::milliseconds kPause{5};
  while (!watch.may_start(remote_ ? remote_->waiting() : std::nullopt)) {
    if (watch.stop_cause()) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

void Deployment::start_watchdog() {
  std::vector<Watchdog::Watched> watched;
  int priority = 0;
  for (const auto& unit : units_) {
    const ComponentConfig& config = config_of(*unit);
    const auto executor =
        std::ranges::find(config_.executors, config.executor, &ExecutorSpec::name);
    priority = std::max(priority, executor->priority);
    const auto declared = declared_max_step(config, config_);
    watched.push_back({.unit = unit.get(),
                       .max_step = declared.value_or(max_step_of({}, unit->period())),
                       .stops_run = hang_stops_run(config, config_)});
  }
  constexpr int kHighest = 99;
  watchdog_.emplace(std::move(watched), priority > 0 ? std::min(priority + 1, kHighest) : 0,
                    options_.on_note);
}

std::string Deployment::run_until_stop(RunWatch& watch) {
  const Time start = clock_->now();
  start_watchdog();
  for (const auto& unit : units_) unit->start_threads(*clock_);
  std::optional<std::string> cause;
  scheduler_->run([&] {
    cause = stop_cause(watch, start);
    return cause.has_value();
  });
  return cause.value_or("nothing is left to do");
}

std::optional<std::string> Deployment::stop_cause(RunWatch& watch, Time start) {
  if (std::string failed = fault(); !failed.empty()) return failed;
  if (any_finished() && !std::exchange(scenario_over_, true) && options_.keeps_running) {
    options_.on_note("the scenario is over; the run goes on until Ctrl-C");
  }
  if (scenario_over_ && !options_.keeps_running) return "the scenario is over";
  if (auto cause = watch.stop_cause()) return cause;
  if (options_.keeps_running) return std::nullopt;
  timed_out_ = config_.time_limit_s > 0 && clock_->now() - start > seconds(config_.time_limit_s);
  if (timed_out_) return fmt::format("the time limit of {:g} s is over", config_.time_limit_s);
  return std::nullopt;
}

void Deployment::come_to_rest(RunWatch& watch) {
  // Who hears an arm from outside of the process hears its samples a little later, and those that
  // are on their way when it ends perhaps never: the ones that show it at rest must not be the
  // last.
  const Duration rest = config_.simulated ? Duration{0} : seconds(0.05);
  const Time end = clock_->now() + seconds(config_.stop_within_s);
  std::optional<Time> rests_since;
  scheduler_->begin_stop();
  scheduler_->run([&] {
    const Time now = clock_->now();
    if (!watch.may_end(find_moving(), end - now)) {
      rests_since.reset();
      return false;
    }
    if (!rests_since) rests_since = now;
    return now - *rests_since >= rest || now >= end;
  });
  moving_ = find_moving();
}

std::vector<std::string> Deployment::find_moving() const {
  std::vector<std::string> names;
  for (const auto& unit : units_) {
    if (!unit->stopped()) names.push_back(unit->name());
  }
  return names;
}

void Deployment::end() {
  for (const ComponentRunner* unit : scheduler_->stop(kStepTimeout)) {
    add_hung(*unit, "step", kStepTimeout);
  }
  for (const auto& unit : units_) unit->request_threads_stop();
  for (const auto& unit : units_) {
    if (is_hung(*unit)) continue;
    tell_ending("stop", *unit);
    unit->stop(clock_->now());
  }
  const auto threads_end = std::chrono::steady_clock::now() + kThreadTimeout;
  for (const auto& unit : units_) {
    if (is_hung(*unit)) continue;
    tell_ending("driver thread", *unit);
    if (!unit->join_threads(threads_end)) add_hung(*unit, "driver thread", kThreadTimeout);
  }
  options_.on_ending("the end of the run");
  if (!remote_) return;
  for (const std::string& refusal : remote_->refusals()) options_.on_note(refusal);
}

void Deployment::add_hung(const ComponentRunner& unit, std::string_view what, Duration timeout) {
  hung_.push_back(&unit);
  std::erase(moving_, unit.name());
  hangs_.push_back(fmt::format("'{}' hangs: its {} has not returned for {:g} s", unit.name(), what,
                               to_seconds(timeout)));
  options_.on_note(hangs_.back());
}

void Deployment::tell_ending(std::string_view function, const ComponentRunner& unit) const {
  options_.on_ending(fmt::format("the {} of '{}'", function, unit.name()));
}

bool Deployment::is_hung(const ComponentRunner& unit) const {
  return std::ranges::find(hung_, &unit) != hung_.end();
}

bool Deployment::any_finished() const {
  return std::any_of(units_.begin(), units_.end(),
                     [](const auto& unit) { return unit->finished(); });
}

std::string Deployment::fault() const {
  for (const auto& unit : units_) {
    if (unit->faulted() && stops_run(config_of(*unit))) return fault_text(*unit);
  }
  return watchdog_ ? watchdog_->verdict() : std::string{};
}

std::vector<std::string> Deployment::isolated_faults() const {
  std::vector<std::string> faults;
  for (const auto& unit : units_) {
    if (!unit->faulted() || stops_run(config_of(*unit))) continue;
    faults.push_back(fault_text(*unit) + " (the run went on without it)");
  }
  return faults;
}

}  // namespace armature
