// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/deployment/component_setup.hpp"
#include "armature/runtime/deployment/lost_peers.hpp"
#include "armature/runtime/deployment/remote_topics.hpp"
#include "armature/runtime/deployment/run_watch.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "armature/runtime/execution/log_publisher.hpp"
#include "armature/runtime/execution/scheduler.hpp"
#include "armature/runtime/execution/watchdog.hpp"
#include "armature/runtime/recording/run_recorder.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature ARMATURE_EXPORT {

/// A deployment in memory: topics, components, scheduler, and the way to other processes. Built in
/// three steps, each of which throws with every problem it finds: the configuration is read
/// (read_deployment), the components are constructed (here), the transport is joined (connect).
class Deployment {
 public:
  struct Options {
    std::string process{kMainProcess};  // constructs only its components; empty: all of them
    /// What components tell the operator, as real-time safe as the components.
    std::function<void(std::string_view component, std::string_view line)> on_line;
    std::function<void(const std::string&)> on_note;  // what the runtime tells the operator
    std::optional<Duration> clock_offset =
        {};  // of the main process' SystemClock; none: an own one
    /// Goes on when the scenario is over, and has no time limit, until it is interrupted.
    bool keeps_running = false;
    /// Before each call at the end of the run that might not return: "the stop of 'arm'".
    std::function<void(const std::string& what)> on_ending = {};
    /// The DDS domain that connect() will join; none: it is constructed and not run.
    std::optional<int> domain = {};
  };

  /// Loads the plugins and constructs the components. Throws config::ConfigError (a plugin refuses
  /// its parameters or robot) or PluginError (a library cannot be used).
  Deployment(DeploymentConfig config, PluginRegistry& plugins, Options options);
  ~Deployment();
  Deployment(const Deployment&) = delete;
  Deployment& operator=(const Deployment&) = delete;

  const DeploymentConfig& config() const { return config_; }
  const Clock& clock() const { return *clock_; }
  const std::vector<std::unique_ptr<ComponentRunner>>& runners() const { return runners_; }
  /// The entry of the deployment that `runner` was made from.
  const ComponentConfig& config_of(const ComponentRunner& runner) const;

  /// Puts a drill's fault, which outlives the deployment, into its component, if that is here.
  void inject(const InjectedFault& fault);

  /// Joins the DDS domain: writers for every output, readers only for inputs that another process
  /// feeds. Another machine may run the same file: processes with another `run` are strangers.
  /// Throws PluginError with the transport's reason.
  void connect(PluginRegistry& plugins, int domain, const std::string& run = {});
  /// The way to other processes; after connect().
  Transport& transport() { return remote_->transport(); }
  /// The main process' offset, as the agent of this host sees it now (SystemClock::follow). Nothing
  /// on the simulated clock.
  void follow_clock(Duration unix_minus_monotonic);

  /// Records the run into `file` as `record:` says, or what happens around each trouble into
  /// `file_at` its time. After connect(). Throws std::runtime_error when the file cannot be
  /// written.
  void record(const std::filesystem::path& file,
              const std::function<std::filesystem::path(Time)>& file_at);
  /// After the run: ends the recording, if there is one, and tells what became of it. `figures` are
  /// those of the run (figures_json), which go into it; empty: this process has none. False when
  /// the recording has no end.
  bool end_recording(const std::string& figures = {});

  /// Waits until the topics between this and the other processes have met, so that what is sent
  /// once is not lost, and until `watch` lets it begin. Then runs until a component is finished or
  /// has failed, the time limit is over, or `watch` says so: from then on it is stopping.
  /// Everything goes on being activated until what moves is at rest, for at most `stop_within_s`;
  /// then it ends, sources first. Throws what `watch` throws.
  void run(RunWatch& watch);

  /// Tells the operator something of the whole run, and whoever reads /rosout; `state`: what it is
  /// about, `ok` for whatever is no trouble.
  void tell(const std::string& text, StatusReporter::State state);
  /// Has the black box written around a trouble of another process, at `at` by the deployment's
  /// clock.
  void mark_trouble(Time at);
  /// When there was trouble in this process since the last call, of several the last time; only of
  /// a run with a black box.
  std::optional<Time> next_trouble();
  /// Whether a component, of any process, had finished when the run began to stop.
  bool scenario_over() const { return scenario_over_; }
  /// True when the run ended because its time limit was over.
  bool timed_out() const { return timed_out_; }
  /// The first fault that ends the run, or the first step that hangs on the way to a driver; or
  /// empty.
  std::string fault() const;
  /// The faults that stayed where they were.
  std::vector<std::string> isolated_faults() const;
  /// The components of this process that were degraded or stalled when the run began to stop, each
  /// with its reason: "left: no picture has come for 2 s".
  const std::vector<std::string>& unwell() const { return unwell_; }
  /// What fell silent of the deployment's other processes while it ran.
  std::vector<std::string> silent() const;
  /// Components that were not at rest when the run ended.
  const std::vector<std::string>& moving() const { return moving_; }
  /// Components whose step or driver thread has not returned; nothing of them may be called any
  /// more, and the process has to be left without destroying the deployment.
  const std::vector<const ComponentRunner*>& hung() const { return hung_; }
  /// Each of them in a sentence: "'arm' hangs: its step has not returned for 2 s".
  const std::vector<std::string>& hangs() const { return hangs_; }
  bool is_hung(const ComponentRunner& runner) const;

  /// Says that the "stop" (or another `function`) of a component is called next (on_ending).
  void tell_ending(std::string_view function, const ComponentRunner& runner) const;

  /// How long the end of a run waits for a step to return.
  static constexpr Duration kStepTimeout = seconds(kSanitized ? 10 : 2);
  /// The same of a driver thread, after that and after the components' `stop`.
  static constexpr Duration kThreadTimeout = seconds(kSanitized ? 5 : 1);

 private:
  /// Lets the log hear what the operator is told.
  void listen_for_log();
  void make_scheduler();
  void make_runner(const ComponentConfig& component, PluginRegistry& plugins,
                   config::Problems& problems);
  void make_own_units(PluginRegistry& plugins);
  void make_own_unit(std::string_view name, const PluginManifest& manifest, int place,
                     PluginRegistry& plugins,
                     const std::function<std::unique_ptr<Component>(Setup&)>& make);
  /// The entry of what the runtime itself adds to `process`.
  ComponentConfig own_config(std::string_view name, const PluginManifest& manifest, int place,
                             const std::string& process) const;
  ComponentSetup setup_of(const ComponentConfig& component, PluginRegistry& plugins,
                          ComponentRunner& runner);
  Topic& topic_for(const ComponentConfig& component, const PortBinding& port,
                   const MessageType& type);
  Topic& topic_at(const std::string& key, const PortBinding& port, const MessageType& type);
  void start_watchdog();
  void assign_runners();
  void on_event(const TransportEvent& event);
  bool await_start(RunWatch& watch);
  /// Returns why it is to stop.
  std::string run_until_stop(RunWatch& watch);
  std::optional<std::string> stop_cause(RunWatch& watch, Time start);
  void mark_trouble(StatusReporter::State state);
  bool any_finished() const;
  std::string component_fault() const;
  std::string hang_fault() const;
  /// Whether the watch is asked now: it asks the system, which costs more than most activations of
  /// a lockstep run, and once in a millisecond will do there.
  bool is_time_to_ask();
  void come_to_rest(RunWatch& watch);
  std::vector<std::string> find_moving() const;
  std::vector<std::string> find_unwell() const;
  void end();
  void add_hung(const ComponentRunner& runner, std::string_view what, Duration timeout);

  DeploymentConfig config_;
  Options options_;
  msg::DeploymentDescription description_;  // of this process, before its first step
  std::unique_ptr<Clock> clock_;
  LogQueue log_;
  StatusReporter::Sink sink_;                             // of components
  std::map<std::string, std::unique_ptr<Topic>> topics_;  // by name, of shared ones also by writer
  std::unique_ptr<Scheduler> scheduler_;
  std::atomic<bool> one_ended_{false};  // finished or failed, and nobody has looked who
  std::vector<std::unique_ptr<ComponentRunner>> runners_;  // in the order of the graph
  std::unique_ptr<RunRecorder> recorder_;                  // null: none
  std::atomic<RunRecorder*> marked_{nullptr};              // told of troubles
  static constexpr std::int64_t kNoTrouble = -1;
  std::atomic<std::int64_t> trouble_ns_{kNoTrouble};  // the last that nobody has asked for
  std::optional<Watchdog> watchdog_;
  std::function<void(const std::string&)> print_note_;
  bool scenario_over_ = false;  // a component has finished
  bool timed_out_ = false;
  std::chrono::steady_clock::time_point asked_{};  // the watch, of a lockstep run
  std::atomic<bool> stopping_{false};
  mutable std::mutex silent_mutex_;
  std::vector<std::string> silent_;
  LostPeers lost_peers_;
  std::vector<std::string> unwell_;
  std::vector<std::string> moving_;
  std::vector<const ComponentRunner*> hung_;
  std::vector<std::string> hangs_;
  std::optional<RemoteTopics> remote_;  // the topics that it has writers of go first
};

}  // namespace armature
