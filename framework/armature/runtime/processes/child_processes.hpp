// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/hosts/host_link.hpp"
#include "armature/runtime/processes/control_channel.hpp"
#include "armature/runtime/reporting/run_timing.hpp"

namespace armature ARMATURE_EXPORT {

/// The other processes of a deployment, started by the main one, or by the agent of another host,
/// and ended by it. They talk over a control channel each. A process says:
///   joined            its components are constructed and its topics are there
///   waiting TEXT      which of its topics has not met its other end
///   ready             all have; it waits for `start`
///   over              the scenario is over, and `stop` follows
///   stop TEXT         it is stopping, and why
///   moving TEXT       while it is stopping: what is not at rest; nothing when all is
///   trouble NS        that something has gone wrong in it then, by the deployment's clock [ns]
///   fault TEXT        what failed in it
///   unwell TEXT       a component of it that was degraded or stalled when it began to stop
///   failed WORD TEXT  the scenario's failure, as a component of it says, and why
///   writing FOLDER    it writes the report's files there, which takes as long as they are
///   wrote NAME        a file that it wrote into the folder of the report
///   timing TEXT       how late and how long an executor or a component of it was (run_timing.hpp)
/// and the main one: start, over, trouble NS, stop TEXT, end. A process whose main one is gone
/// comes to rest by itself and ends. The agent of a host says, of itself and of its processes:
///   here FINGERPRINT  it waits to be welcomed; `refuse TEXT`: it does not fit
///   note TEXT         what the operator is to know
///   ended TEXT        how it has ended
class ChildProcesses {
 public:
  ChildProcesses() = default;
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;
  /// Ends those that still run.
  ~ChildProcesses();

  /// Runs this executable again with `arguments` and the control option. `on_loss` says what it
  /// does when the process ends by itself after begin(). Throws std::system_error.
  void start(const std::string& name, std::vector<std::string> arguments, OnFault on_loss);
  /// The processes of another host, which its agent starts.
  struct Host {
    std::unique_ptr<HostLink> link;
    std::vector<std::pair<std::string, OnFault>> processes;  // each with what its loss does
    std::string fingerprint;                                 // that its agent has to have
    std::string welcome;                                     // what the agent is told then
  };
  void expect(Host host);
  bool empty() const { return children_.empty(); }

  /// Hears what they have said, and sees who has ended or was stopped.
  void update();
  /// Tells all to start. One that is lost before always stops the run.
  void begin();
  void send(std::string_view line);

  /// A host whose agent has not come, if any.
  std::optional<std::string> missing_host() const;
  /// A process that has not said `joined`, if any.
  std::optional<std::string> not_joined() const;
  /// Which topic of one of them waits for which other process, or that one is not ready.
  std::optional<std::string> waiting() const;
  /// Why the run is to stop: one is stopping, or has ended by itself and is not isolated.
  std::optional<std::string> stop_cause() const;
  /// Whether it is over in one of them.
  bool scenario_over() const { return scenario_over_; }
  /// What the operator is to know, each once: how one was lost without which the run goes on, what
  /// the agent of a host says.
  std::optional<std::string> next_note();
  /// When there was trouble in one of them, each once.
  std::optional<Time> next_trouble();
  /// What is not at rest, by process; one that has ended is.
  std::vector<std::string> moving() const;
  /// What went wrong with them: ended by themselves, failed, were stopped for too long.
  const std::vector<std::string>& faults() const { return faults_; }

  const std::vector<std::string>& unwell() const { return unwell_; }
  /// Status and reason, of the first that told one.
  const std::optional<std::pair<std::string, std::string>>& failed() const { return failed_; }
  /// Names of files in the folder of the report.
  const std::vector<std::string>& written() const { return written_; }

  /// Adds what they have told of their timing.
  void add_timing(RunTiming& timing) const;

  /// Ends those processes that `which` names and waits for them, and the agents of hosts that have
  /// none left; one that takes longer than 3 s, or 10 s for its files, is killed, which is a fault.
  /// A host whose agent has
  /// not come has nothing to end.
  void end(const std::function<bool(const std::string& name)>& which);

 private:
  using SteadyClock = std::chrono::steady_clock;
  struct Child {
    std::string name;   // of the process; "" of the agent of a host
    std::string label;  // "process 'vision'"
    OnFault on_loss;
    std::unique_ptr<ControlChannel> control;
    pid_t pid = 0;                               // 0: on another host
    HostLink* host = nullptr;                    // which
    std::string fingerprint = {}, welcome = {};  // of an agent
    bool joined = false, ready = false, told_end = false, told_fault = false, ended = false;
    std::string waiting = {}, stop_cause = {};
    std::string moving = {};  // of one that has been told to stop
    std::optional<SteadyClock::time_point> halted_at = {}, writes_since = {};
    std::vector<std::string> timing = {};
    bool is_agent() const { return name.empty(); }
  };
  void hear(Child& child);
  void welcome(Child& agent, const std::string& fingerprint);
  void watch(Child& child);
  /// `how`: "was killed by signal 9". That one was told to end and has is no fault where its exit
  /// code is 0, and none beside the fault that it has told.
  void on_ended(Child& child, const std::string& how);
  void on_continued(Child& child);
  bool may_end(const Child& child) const;
  void give_up(Child& child, std::chrono::seconds timeout);

  std::vector<std::unique_ptr<HostLink>> hosts_;
  std::deque<Child> children_;  // those of a host go before it
  bool begun_ = false, scenario_over_ = false;
  std::optional<SteadyClock::time_point> updated_;
  Duration stood_still_{0};        // between two updates, when that was too long for other hosts
  std::deque<std::string> notes_;  // not told yet
  std::set<std::string> doubled_;  // hosts, as which several answer; told
  std::deque<Time> troubles_;      // the same
  std::vector<std::string> faults_, unwell_, written_;
  std::optional<std::pair<std::string, std::string>> failed_;
};

}  // namespace armature
