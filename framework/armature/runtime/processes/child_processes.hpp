// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/processes/control_channel.hpp"
#include "armature/runtime/reporting/run_timing.hpp"

namespace armature ARMATURE_EXPORT {

/// The other processes of a deployment, started by the main one and ended by it. They talk over a
/// control channel each. A process says:
///   joined            its components are constructed and its topics are there
///   waiting TEXT      which of its topics has not met its other end
///   ready             all have; it waits for `start`
///   stop TEXT         it is stopping, and why
///   moving TEXT       while it is stopping: what is not at rest; nothing when all is
///   fault TEXT        what failed in it
///   timing TEXT       how late and how long an executor or a component of it was (run_timing.hpp)
/// and the main one: start, stop TEXT, end. A process whose main one is gone comes to rest by
/// itself and ends.
class ChildProcesses {
 public:
  ChildProcesses() = default;
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;
  /// Ends those that still run.
  ~ChildProcesses();

  /// The option by which a process is told the descriptor of its control channel.
  static constexpr std::string_view kControlOption = "--control";

  /// Runs this executable again with `arguments` and the control option. `on_loss` says what it
  /// does when the process ends by itself after begin(). Throws std::system_error.
  void start(const std::string& name, std::vector<std::string> arguments, OnFault on_loss);
  bool empty() const { return children_.empty(); }

  /// Hears what they have said, and sees who has ended or was stopped.
  void update();
  /// Tells all to start. One that is lost before always stops the run.
  void begin();
  void send(std::string_view line);

  /// One that has not said `joined`, if any.
  std::optional<std::string> not_joined() const;
  /// Which topic of one of them waits for which other process, or that one is not ready.
  std::optional<std::string> waiting() const;
  /// Why the run is to stop: one is stopping, or has ended by itself and is not isolated.
  std::optional<std::string> stop_cause() const;
  /// How the next one was lost without which the run goes on; each is told once.
  std::optional<std::string> next_isolated();
  /// What is not at rest, by process; one that has ended is.
  std::vector<std::string> moving() const;
  /// What went wrong with them: ended by themselves, failed, were stopped for too long.
  const std::vector<std::string>& faults() const { return faults_; }

  /// Adds what they have told of their timing.
  void add_timing(RunTiming& timing) const;

  /// Ends those processes that `which` names and waits for them; one that takes longer than 3 s is
  /// killed, which is a fault.
  void end(const std::function<bool(const std::string& name)>& which);

 private:
  using SteadyClock = std::chrono::steady_clock;
  struct Child {
    std::string name;
    pid_t pid;
    OnFault on_loss;
    ControlChannel control;
    bool joined = false, ready = false, told_end = false, ended = false;
    std::string waiting = {}, stop_cause = {};
    std::string moving = {};  // of one that has been told to stop
    std::optional<SteadyClock::time_point> halted_at = {};
    std::vector<std::string> timing = {};
  };
  void hear(Child& child);
  void watch(Child& child);
  void on_ended(Child& child, int status);
  void on_continued(Child& child);

  std::deque<Child> children_;
  bool begun_ = false;
  std::deque<std::string> isolated_;  // lost, and not told yet
  std::vector<std::string> faults_;
};

}  // namespace armature
