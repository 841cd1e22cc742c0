// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment/run_watch.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/processes/child_processes.hpp"
#include "armature/runtime/processes/control_channel.hpp"
#include "run/console.hpp"

namespace armature {

/// What every process of a deployment listens to: the operator's signals and the system clock.
class ProcessWatch : public RunWatch {
 public:
  explicit ProcessWatch(Console& console) : console_{&console} {}

  /// The operator's signal or closed terminal that ended the run, if one did.
  const std::optional<std::string>& interruption() const { return interruption_; }
  /// True when the system clock was stepped while the run lasted.
  bool clock_was_stepped() const { return steps_.any(); }

 protected:
  Console& console() { return *console_; }
  std::optional<std::string> interruption_now();
  /// Takes back the operator's signals where a plugin has set handlers of its own; told once.
  void keep_signals();
  /// How far the system clock was stepped since the last call, if it was.
  std::optional<Duration> clock_step() { return steps_.next(); }

 private:
  Console* console_;
  ClockSteps steps_;
  bool told_taken_ = false;  // that a plugin took a signal
  std::optional<std::string> interruption_;
};

/// Of the main process: it starts the others together, makes all of them stop together, and ends
/// those that move something last.
class MainWatch final : public ProcessWatch {
 public:
  MainWatch(Console& console, ChildProcesses& children, Deployment& deployment);

  bool may_start(const std::optional<std::string>& waiting) override;
  std::optional<std::string> stop_cause() override;
  bool scenario_over() const override { return children_->scenario_over(); }
  void stopping(const std::string& cause, bool scenario_over) override;
  bool may_end(const std::vector<std::string>& moving, Duration left) override;
  void ending() override;

  /// True once the run has begun, in all of its processes.
  bool started() const { return started_; }
  /// Ends the processes that are left. What went wrong in any of them.
  std::vector<std::string> end_all();

 private:
  using SteadyClock = std::chrono::steady_clock;
  void tell_step(const std::string& text);
  void tell_trouble(const std::string& text);
  void tell_clock_step();
  void tell_notes();
  /// Tells troubles of any process to all others: their black boxes have what happened around them.
  void pass_on_troubles();
  [[noreturn]] void refuse_to_start(const std::string& waiting) const;

  ChildProcesses* children_;
  Deployment* deployment_;
  std::vector<std::string> with_driver_;  // processes that move something
  bool simulated_;
  std::chrono::seconds meet_within_;
  double stop_within_s_;
  SteadyClock::time_point asked_first_ = SteadyClock::now();
  std::optional<SteadyClock::time_point> joined_;
  bool started_ = false, told_of_late_ = false;
  std::string told_missing_;  // host that was waited for
  int told_signals_ = 1;
  std::vector<std::string> moving_;  // in other processes, when the time was over
  /// Tells other hosts that this process is there while its own components end, which may take
  /// longer than a host waits. It goes before what it uses.
  std::jthread still_here_;
};

/// Of another process: the main one says when to start, to stop and to end. Without a main one (the
/// process was started by hand) it goes by itself.
class ChildWatch final : public ProcessWatch {
 public:
  /// `control`: the descriptor of the way to the main process, or -1.
  ChildWatch(Console& console, int control) : ProcessWatch{console}, control_{control} {}

  bool may_start(const std::optional<std::string>& waiting) override;
  std::optional<std::string> stop_cause() override;
  Duration grace() const override;
  bool scenario_over() const override { return scenario_over_; }
  void stopping(const std::string& cause, bool scenario_over) override;
  bool may_end(const std::vector<std::string>& moving, Duration left) override;

  /// The deployment that runs here. During the run it is told the main process' clock, as the agent
  /// of this host sees it, and troubles of the other processes.
  void set_deployment(Deployment& deployment) { deployment_ = &deployment; }
  /// True without a main process.
  bool alone() const { return control_.file() < 0; }
  /// True once the run has begun here.
  bool started() const { return started_; }
  /// Tells the main process what failed here, "" for nothing.
  void tell_fault(const std::string& fault);
  /// Tells the main process something else of the end: `word` is one of ChildProcesses.
  void tell(std::string_view word, const std::string& text);
  /// Tells the main process, or without one the operator, who was late.
  void tell_timing(const RunTiming& timing);

 private:
  using SteadyClock = std::chrono::steady_clock;
  void hear();
  void tell_trouble();
  /// True once the main process has let a stop of this one unanswered for too long; told once.
  bool main_is_silent();
  /// Sends a line unless it is the last one of its kind again.
  void say(std::string& last, std::string line);

  SocketChannel control_;
  Deployment* deployment_ = nullptr;
  bool started_ = false, scenario_over_ = false, told_end_ = false;
  std::string stop_;      // as the main process said
  std::string own_stop_;  // which it is to answer
  SteadyClock::time_point requested_at_;
  bool told_silent_ = false;
  std::string said_joined_, said_waiting_, said_moving_;
};

}  // namespace armature
