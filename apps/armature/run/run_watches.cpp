// SPDX-License-Identifier: Apache-2.0
#include "run/run_watches.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <utility>

#include "armature/bus/network_interface.hpp"
#include "armature/values/sanitizer.hpp"
#include "run/end_signals.hpp"

namespace armature {
namespace {

/// How long processes that have joined may take to meet.
constexpr std::chrono::seconds kMeetWithin{kSanitized ? 25 : 5};
/// The same between hosts, where packets are lost and Fast DDS takes its time to send them again.
constexpr std::chrono::seconds kHostsMeetWithin{5 * kMeetWithin};
/// How long the main process, which looks every 20 ms, may take to answer that another one stops.
constexpr std::chrono::seconds kAnswersWithin{kSanitized ? 5 : 1};

std::string trouble_line(Time at) { return fmt::format("trouble {}", at.ns); }

bool has_loopback() {
  return std::ranges::any_of(network_interfaces(), [](const NetworkInterface& one) {
    return one.up && std::ranges::find(one.addresses, "127.0.0.1") != one.addresses.end();
  });
}

}  // namespace

void ProcessWatch::keep_signals() {
  const std::string taken = end_signals::take_back();
  if (taken.empty() || std::exchange(told_taken_, true)) return;
  console_->line("runtime", fmt::format("a plugin or its library has taken {} for itself; it does "
                                        "not keep it: {} stops this run as before",
                                        taken, taken));
}

std::optional<std::string> ProcessWatch::interruption_now() {
  keep_signals();
  if (!interruption_) interruption_ = end_signals::cause();
  if (!interruption_) interruption_ = console_->lost_reader();
  return interruption_;
}

MainWatch::MainWatch(Console& console, ChildProcesses& children, Deployment& deployment)
    : ProcessWatch{console},
      children_{&children},
      deployment_{&deployment},
      simulated_{deployment.config().simulated},
      meet_within_{deployment.config().hosts().size() > 1 ? kHostsMeetWithin : kMeetWithin},
      stop_within_s_{deployment.config().stop_within_s} {
  for (const ComponentConfig& component : deployment.config().components) {
    if (component.manifest && component.manifest->driver) with_driver_.push_back(component.process);
  }
}

void MainWatch::tell_step(const std::string& text) {
  deployment_->tell(text, StatusReporter::State::ok);
}

void MainWatch::tell_trouble(const std::string& text) {
  deployment_->tell(text, StatusReporter::State::degraded);
}

void MainWatch::tell_notes() {
  while (const auto note = children_->next_note()) tell_trouble(*note);
}

void MainWatch::pass_on_troubles() {
  if (const auto own = deployment_->next_trouble()) children_->send(trouble_line(*own));
  while (const auto other = children_->next_trouble()) {
    deployment_->mark_trouble(*other);
    children_->send(trouble_line(*other));
  }
}

bool MainWatch::may_start(const std::optional<std::string>& waiting) {
  children_->update();
  tell_notes();
  if (children_->stop_cause()) return false;
  const auto now = SteadyClock::now();
  if (const auto host = children_->missing_host()) {
    if (told_missing_ != *host) {
      tell_step(
          fmt::format("waiting for host '{}': run the same file there with --host {}; if it runs "
                      "already, its messages do not come (a firewall, or not the same MTU all the "
                      "way)",
                      *host, *host));
    }
    told_missing_ = *host;
    asked_first_ = now;
    return false;
  }
  if (const auto late = children_->not_joined()) {
    if (!told_of_late_ && now - asked_first_ > kMeetWithin) {
      told_of_late_ = true;
      tell_step(fmt::format("waiting for {} to be constructed", *late));
    }
    return false;
  }
  if (!joined_) joined_ = now;
  const auto there = waiting ? waiting : children_->waiting();
  if (there && now - *joined_ > meet_within_) {
    refuse_to_start(*there);
  }
  if (there) return false;
  children_->begin();
  started_ = true;
  return true;
}

void MainWatch::refuse_to_start(const std::string& waiting) const {
  throw std::runtime_error{
      fmt::format("not started: {} within {} s{}", waiting, meet_within_.count(),
                  has_loopback() ? "; is the machine very busy, or is there a firewall?"
                                 : "; the loopback interface is down, and processes meet over it: "
                                   "'ip link set lo up'")};
}

void MainWatch::tell_clock_step() {
  const auto step = clock_step();
  if (!step || simulated_) return;
  tell_trouble(
      fmt::format("the system clock stepped by {:+g} s; the deployment's clock goes on "
                  "as before, and so do ages and leases",
                  std::round(to_seconds(*step) * 10) / 10));
}

std::optional<std::string> MainWatch::stop_cause() {
  tell_clock_step();
  children_->update();
  tell_notes();
  if (started_) pass_on_troubles();
  auto cause = interruption_now();
  const auto host = cause ? children_->missing_host() : std::nullopt;
  if (!cause) cause = children_->stop_cause();
  if (!cause || started_) return cause;
  throw std::runtime_error{
      *cause + (host ? " while it waited for host '" + *host + "'" : " before the start")};
}

void MainWatch::stopping(const std::string& cause, bool scenario_over) {
  tell_step("stopping: " + cause);
  if (scenario_over) children_->send("over");
  children_->send("stop " + cause);
}

bool MainWatch::may_end(const std::vector<std::string>& moving, Duration left) {
  keep_signals();
  tell_clock_step();
  children_->update();
  pass_on_troubles();
  if (end_signals::count() > told_signals_) {
    told_signals_ = end_signals::count();
    tell_step(
        fmt::format("stopping, at most {:.1f} s more; a third signal ends at "
                    "once",
                    std::max(0.0, to_seconds(left))));
  }
  moving_ = children_->moving();
  return (moving.empty() && moving_.empty()) || left <= Duration{0};
}

void MainWatch::ending() {
  children_->end([this](const std::string& process) {
    return std::ranges::find(with_driver_, process) == with_driver_.end();
  });
  still_here_ = std::jthread{[this](const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      children_->update();
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
  }};
}

std::vector<std::string> MainWatch::end_all() {
  still_here_ = {};
  children_->end([](const std::string&) { return true; });
  std::vector<std::string> faults = children_->faults();
  for (const std::string& moving : moving_) {
    faults.push_back(
        fmt::format("{} was not at rest {:g} s after it was to stop", moving, stop_within_s_));
  }
  return faults;
}

void ChildWatch::say(std::string& last, std::string line) {
  if (line == last) return;
  last = std::move(line);
  control_.send(last);
}

void ChildWatch::hear() {
  while (const auto line = control_.receive()) {
    started_ = started_ || *line == "start";
    scenario_over_ = scenario_over_ || *line == "over";
    told_end_ = told_end_ || *line == "end";
    if (line->starts_with("stop ")) stop_ = line->substr(5);
    if (line->starts_with("trouble ")) deployment_->mark_trouble(Time{std::stoll(line->substr(8))});
    if (line->starts_with("clock ")) {
      deployment_->follow_clock(Duration{std::stoll(line->substr(6))});
    }
  }
}

void ChildWatch::tell_trouble() {
  if (const auto at = deployment_->next_trouble()) control_.send(trouble_line(*at));
}

bool ChildWatch::may_start(const std::optional<std::string>& waiting) {
  if (alone()) {
    // Whoever starts the processes by hand takes his time.
    if (waiting && *waiting != said_waiting_) console().line("runtime", "waiting: " + *waiting);
    said_waiting_ = waiting.value_or("");
    started_ = !waiting;
    return started_;
  }
  hear();
  say(said_joined_, "joined");
  say(said_waiting_, waiting ? "waiting " + *waiting : "ready");
  return started_;
}

std::optional<std::string> ChildWatch::stop_cause() {
  clock_step();
  hear();
  if (started_) tell_trouble();
  if (control_.lost()) return "the main process is gone";
  if (told_end_) return "the main process ends it";
  if (!stop_.empty()) return stop_;
  const auto cause = interruption_now();
  if (cause && alone() && !started_) throw std::runtime_error{*cause + " before the start"};
  return cause;
}

Duration ChildWatch::grace() const { return alone() ? Duration{} : kAnswersWithin; }

void ChildWatch::stopping(const std::string& cause, bool scenario_over) {
  if (stop_.empty()) {
    if (scenario_over) control_.send("over");
    control_.send("stop " + cause);
    own_stop_ = cause;
    requested_at_ = SteadyClock::now();
  }
  if (alone() || control_.lost()) console().line("runtime", "stopping: " + cause);
}

bool ChildWatch::may_end(const std::vector<std::string>& moving, Duration left) {
  keep_signals();
  clock_step();
  hear();
  tell_trouble();
  if (moving.empty()) {
    say(said_moving_, "moving");
  } else {
    say(said_moving_, fmt::format("moving {}", fmt::join(moving, "', '")));
  }
  if (told_end_) return true;
  return (alone() || control_.lost() || main_is_silent()) && RunWatch::may_end(moving, left);
}

bool ChildWatch::main_is_silent() {
  if (own_stop_.empty() || !stop_.empty()) return false;
  if (SteadyClock::now() - requested_at_ < kAnswersWithin) return false;
  if (!std::exchange(told_silent_, true)) {
    console().line("runtime", fmt::format("stopping: {}; the main process does not answer, and "
                                          "this one ends by itself",
                                          own_stop_));
  }
  return true;
}

void ChildWatch::tell_timing(const RunTiming& timing) {
  if (alone()) fmt::print(stderr, "{}", to_table(timing));
  for (const std::string& line : to_lines(timing)) control_.send("timing " + line);
}

void ChildWatch::tell_fault(const std::string& fault) {
  if (!fault.empty()) tell("fault", fault);
}

void ChildWatch::tell(std::string_view word, const std::string& text) {
  control_.send(fmt::format("{} {}", word, text));
}

}  // namespace armature
