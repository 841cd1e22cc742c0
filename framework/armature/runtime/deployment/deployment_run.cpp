// SPDX-License-Identifier: Apache-2.0
// A run of a deployment: waiting for the others, running, stopping, ended.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment/description.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {
namespace {

std::string status_text(const ComponentRunner& runner) {
  return runner.name() + ": " + runner.status().reason;
}

}  // namespace

void Deployment::run(RunWatch& watch) {
  if (description_.deployment_().empty())
    description_ = description_of(config_, options_.process, "");
  if (await_start(watch)) {
    const std::string cause = run_until_stop(watch);
    unwell_ = find_unwell();
    stopping_ = true;
    scenario_over_ = scenario_over_ || watch.scenario_over();
    if (!scenario_over_) mark_trouble(StatusReporter::State::degraded);
    watch.stopping(cause, scenario_over_);
    come_to_rest(watch);
  }
  watch.ending();
  end();
}

bool Deployment::await_start(RunWatch& watch) {
  constexpr std::chrono::milliseconds kPause{5};
  while (!watch.may_start(remote_ ? remote_->waiting(clock_->now()) : std::nullopt)) {
    if (watch.stop_cause()) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

void Deployment::start_watchdog() {
  std::vector<Watchdog::Watched> watched;
  int priority = 0;
  for (const auto& runner : runners_) {
    const ComponentConfig& config = config_of(*runner);
    const auto executor =
        std::ranges::find(config_.executors, config.executor, &ExecutorSpec::name);
    priority = std::max(priority, executor->priority);
    const auto declared = declared_max_step(config, config_);
    watched.push_back({.runner = runner.get(),
                       .max_step = declared.value_or(max_step_of({}, runner->period())),
                       .stops_run = hang_stops_run(config, config_)});
  }
  constexpr int kHighest = 99;
  watchdog_.emplace(std::move(watched), priority > 0 ? std::min(priority + 1, kHighest) : 0,
                    options_.on_note);
}

std::string Deployment::run_until_stop(RunWatch& watch) {
  const Time start = clock_->now();
  start_watchdog();
  for (const auto& runner : runners_) runner->start_threads(*clock_);
  std::optional<std::string> cause;
  scheduler_->run([&] {
    cause = stop_cause(watch, start);
    return cause.has_value();
  });
  return cause.value_or("nothing is left to do");
}

std::optional<std::string> Deployment::stop_cause(RunWatch& watch, Time start) {
  // Asked at every event of a lockstep run: who failed or finished is looked for when one did.
  if (one_ended_.load(std::memory_order_relaxed) && one_ended_.exchange(false)) {
    if (std::string failed = component_fault(); !failed.empty()) return failed;
    if (any_finished() && !std::exchange(scenario_over_, true) && options_.keeps_running) {
      tell("the scenario is over; the run goes on until Ctrl-C", StatusReporter::State::ok);
    }
  }
  if (std::string hang = hang_fault(); !hang.empty()) return hang;
  if (scenario_over_ && !options_.keeps_running) return "the scenario is over";
  // Before another process' stop is heard, so that the limit counts whoever sees it first.
  timed_out_ = config_.time_limit_s > 0 && !options_.keeps_running &&
               clock_->now() - start > seconds(config_.time_limit_s) + watch.grace();
  if (is_time_to_ask()) {
    if (auto cause = watch.stop_cause()) {
      timed_out_ = timed_out_ && !watch.scenario_over();
      return cause;
    }
  }
  if (timed_out_) return fmt::format("the time limit of {:g} s is over", config_.time_limit_s);
  return std::nullopt;
}

bool Deployment::is_time_to_ask() {
  if (!config_.simulated) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now - asked_ < std::chrono::milliseconds{1}) return false;
  asked_ = now;
  return true;
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
  for (const auto& runner : runners_) {
    if (!runner->stopped()) names.push_back(runner->name());
  }
  return names;
}

std::vector<std::string> Deployment::find_unwell() const {
  std::vector<std::string> unwell;
  for (const auto& runner : runners_) {
    const StatusReporter::State state = runner->status().state;
    if (state == StatusReporter::State::degraded || state == StatusReporter::State::stalled) {
      unwell.push_back(status_text(*runner));
    }
  }
  return unwell;
}

void Deployment::end() {
  for (const ComponentRunner* runner : scheduler_->stop(kStepTimeout)) {
    add_hung(*runner, "step", kStepTimeout);
  }
  for (const auto& runner : runners_) runner->request_threads_stop();
  for (const auto& runner : runners_) {
    if (is_hung(*runner)) continue;
    tell_ending("stop", *runner);
    runner->stop(clock_->now());
  }
  const auto threads_end = std::chrono::steady_clock::now() + kThreadTimeout;
  for (const auto& runner : runners_) {
    if (is_hung(*runner)) continue;
    tell_ending("driver thread", *runner);
    if (!runner->join_threads(threads_end)) add_hung(*runner, "driver thread", kThreadTimeout);
  }
  options_.on_ending("the end of the run");
  if (!remote_) return;
  for (const std::string& refusal : remote_->refusals()) options_.on_note(refusal);
}

bool Deployment::end_recording(const std::string& figures) {
  if (!recorder_) return true;
  options_.on_ending("the end of the recording");
  std::optional<McapAttachment> attached;
  if (!figures.empty()) {
    attached = {.log_time = clock_->now(),
                .create_time = clock_->now(),
                .name = std::string{kFiguresAttachment},
                .media_type = "application/json",
                .data = figures};
  }
  try {
    const std::string file = recorder_->close(attached);
    if (!file.empty()) tell("recorded: " + file, StatusReporter::State::ok);
    return true;
  } catch (const std::exception& error) {
    options_.on_note(
        fmt::format("the recording has no end: {}; what is in it is made whole by: "
                    "armature record --repair",
                    error.what()));
    return false;
  }
}

void Deployment::add_hung(const ComponentRunner& runner, std::string_view what, Duration timeout) {
  hung_.push_back(&runner);
  std::erase(moving_, runner.name());
  hangs_.push_back(fmt::format("'{}' hangs: its {} has not returned for {:g} s", runner.name(),
                               what, to_seconds(timeout)));
  options_.on_note(hangs_.back());
}

void Deployment::tell_ending(std::string_view function, const ComponentRunner& runner) const {
  options_.on_ending(fmt::format("the {} of '{}'", function, runner.name()));
}

bool Deployment::is_hung(const ComponentRunner& runner) const {
  return std::ranges::find(hung_, &runner) != hung_.end();
}

bool Deployment::any_finished() const {
  return std::any_of(runners_.begin(), runners_.end(),
                     [](const auto& runner) { return runner->finished(); });
}

std::string Deployment::component_fault() const {
  for (const auto& runner : runners_) {
    if (runner->faulted() && stops_run(config_of(*runner))) return status_text(*runner);
  }
  return {};
}

std::string Deployment::hang_fault() const {
  return watchdog_ ? watchdog_->verdict() : std::string{};
}

std::string Deployment::fault() const {
  std::string failed = component_fault();
  return failed.empty() ? hang_fault() : failed;
}

std::vector<std::string> Deployment::isolated_faults() const {
  std::vector<std::string> faults;
  for (const auto& runner : runners_) {
    if (!runner->faulted() || stops_run(config_of(*runner))) continue;
    faults.push_back(status_text(*runner) + " (the run went on without it)");
  }
  return faults;
}

}  // namespace armature
