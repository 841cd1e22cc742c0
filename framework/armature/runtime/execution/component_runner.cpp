// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/component_runner.hpp"

#include <fmt/format.h>
#include <time.h>

#include <utility>

#include "armature/runtime/deployment_file/injected_fault.hpp"
#include "armature/runtime/execution/float_environment.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature {
namespace {

Duration read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + Duration{now.tv_nsec};
}

}  // namespace

/// Says while it exists that the component's step runs: to the watchdog, and to who reads of a
/// crash.
class ComponentRunner::Running {
 public:
  Running(ComponentRunner& runner, const char* phase)
      : runner_{runner}, component_{runner.name_, phase}, start_{read_clock(CLOCK_MONOTONIC)} {
    runner_.running_since_ns_.store(start_.count(), std::memory_order_relaxed);
  }
  ~Running() {
    runner_.running_since_ns_.store(0, std::memory_order_relaxed);
    if (!floats_.restore() || std::exchange(runner_.told_floats_, true)) return;
    runner_.reporter_->log(
        "it has changed how its thread computes (rounding, traps or the smallest numbers), which "
        "is set back after each step: the others on this thread would compute otherwise");
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  Duration start() const { return start_; }

 private:
  ComponentRunner& runner_;
  RunningComponent component_;
  FloatEnvironment floats_;
  Duration start_;
};

/// Tells the tap, if there is one, of a call while it exists.
class ComponentRunner::Tapped {
 public:
  Tapped(const ComponentRunner& runner, ComponentCall call, Time now)
      : runner_{runner}, tap_{runner.inbox().tap()} {
    if (tap_) tap_->begin(call, now);
  }
  ~Tapped() {
    if (tap_) tap_->end(runner_.faulted() ? runner_.status().reason : std::string{});
  }
  Tapped(const Tapped&) = delete;
  Tapped& operator=(const Tapped&) = delete;

 private:
  const ComponentRunner& runner_;
  ActivationTap* tap_;
};

ComponentRunner::ComponentRunner(std::string name, std::string plugin_id, int place,
                                 StatusReporter::Sink sink)
    : name_{std::move(name)},
      plugin_id_{std::move(plugin_id)},
      place_{place},
      inbox_{[this] {
        if (triggered_) triggered_();
      }},
      reporter_{std::make_shared<StatusReporter>(name_, std::move(sink))} {}

void ComponentRunner::activate(Time now, Duration lateness) {
  answer_stop_request(now);
  if (finished()) return;
  step(now, lateness);
  if (!finished()) return;
  inbox_.close();
  if (ended_) ended_->store(true, std::memory_order_release);
}

void ComponentRunner::step(Time now, Duration lateness) {
  if (faulted()) return;
  for (const auto& slot : slots_) slot->exchange();
  const Tapped tapped{*this, ComponentCall::step, now};
  inbox_.show(now);
  activations_.fetch_add(1, std::memory_order_relaxed);
  times_.lateness.add(lateness);
  const Running running{*this, "step"};
  // In lockstep there is one thread, which waits for nobody: the system need not be asked.
  const bool is_shared = executor_times_ != nullptr;
  const Duration processor = is_shared ? read_clock(CLOCK_THREAD_CPUTIME_ID) : Duration{0};
  try {
    if (injected_) injected_->strike_if_armed();
    component_->step(now);
    if (component_->finished()) finished_.store(true, std::memory_order_release);
    if (stop_begun_) ask_stopped();
  } catch (...) {
    fault("step", current_exception_text());
  }
  const Duration duration = read_clock(CLOCK_MONOTONIC) - running.start();
  times_.processor.add(is_shared ? read_clock(CLOCK_THREAD_CPUTIME_ID) - processor : duration);
  times_.duration.add(duration);
  count_reaction(now, duration);
}

void ComponentRunner::count_reaction(Time now, Duration duration) {
  const auto [source, at] = inbox_.answers_to();
  if (source < 0 || static_cast<std::size_t>(source) >= reactions_.size()) return;
  // In lockstep a step takes what it was said to take.
  const Duration took = executor_times_ ? duration : latency_;
  reactions_[static_cast<std::size_t>(source)].add(now + took - at);
}

void ComponentRunner::answer_stop_request(Time now) {
  if (stop_begun_ || faulted() || !stop_requested_.load(std::memory_order_acquire)) return;
  stop_begun_ = true;
  const Tapped tapped{*this, ComponentCall::begin_stop, now};
  const Running running{*this, "begin_stop"};
  try {
    component_->begin_stop(now);
    ask_stopped();
  } catch (...) {
    fault("begin_stop", current_exception_text());
  }
}

void ComponentRunner::ask_stopped() {
  const bool stopped = component_->stopped();
  stopped_.store(stopped, std::memory_order_release);
  // Others end before it does, and that it hears nothing of them then is no trouble.
  reporter_->keep_to_itself(stopped);
}

void ComponentRunner::start_threads(const Clock& clock) {
  if (std::exchange(threads_started_, true)) return;
  for (const auto& thread : threads_) {
    thread->start(name_,
                  {.now = [&clock] { return clock.now(); },
                   .wake =
                       [this] {
                         if (triggered_) triggered_();
                       },
                   .fault = [this](const std::string& what) { fault("driver thread", what); }});
  }
}

void ComponentRunner::request_threads_stop() {
  for (const auto& thread : threads_) thread->request_stop();
}

bool ComponentRunner::join_threads(std::chrono::steady_clock::time_point end) {
  bool joined = true;
  for (const auto& thread : threads_) joined = thread->join_until(end) && joined;
  return joined;
}

std::uint64_t ComponentRunner::dropped() const {
  std::uint64_t dropped = inbox_.dropped();
  for (const auto& thread : threads_) dropped += thread->dropped();
  for (const OutputPort& output : outputs_) {
    if (const RemoteWriter* remote = output.topic().remote()) dropped += remote->dropped();
  }
  return dropped;
}

void ComponentRunner::stop(Time now) {
  if (!component_ || faulted()) return;
  const Tapped tapped{*this, ComponentCall::stop, now};
  const RunningComponent running{name_, "stop"};
  const FloatEnvironment floats;
  try {
    component_->stop(now);
  } catch (...) {
    fault("stop", current_exception_text());
  }
}

void ComponentRunner::summarize(Summary& summary) {
  const RunningComponent running{name_, "summarize"};
  const FloatEnvironment floats;
  try {
    component_->summarize(summary);
  } catch (...) {
    fault("summarize", current_exception_text());
  }
}

std::vector<std::string> ComponentRunner::notes_for_check() const {
  const RunningComponent running{name_, "notes for check"};
  return component_->notes_for_check();
}

void ComponentRunner::fault(std::string_view when, const std::string& what) {
  reporter_->set(StatusReporter::State::fault, fmt::format("{} failed: {}", when, what));
  faulted_.store(true, std::memory_order_release);
  for (OutputPort& output : outputs_) output.close();
  if (ended_) ended_->store(true, std::memory_order_release);
}

}  // namespace armature
