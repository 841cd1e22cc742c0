// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/params.hpp"
#include "armature/runtime/deployment_file/dds_config.hpp"
#include "armature/runtime/deployment_file/executor_spec.hpp"
#include "armature/runtime/deployment_file/record_config.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature ARMATURE_EXPORT {

/// The longest time that a file may let anything wait: a longer one is a slip of the pen.
inline constexpr double kLongestWait_s = 3600;
inline constexpr std::string_view kMainProcess = "main";
inline constexpr std::string_view kMainHost = "main";  // where the main process runs
inline constexpr std::string_view kMainExecutor = "main";
inline constexpr std::string_view kRuntimeExecutor = "runtime";  // of the runtime's own components
// The runtime's own components, which every process has (the clock: on the simulated clock).
inline constexpr std::string_view kStateComponent = "runtime";
inline constexpr std::string_view kLogComponent = "runtime_log";
inline constexpr std::string_view kClockComponent = "runtime_clock";
inline constexpr std::array kRuntimeComponents{kStateComponent, kLogComponent, kClockComponent};

/// A plugin in a slot, resolved: known by its manifest, its parameters checked.
struct SlotConfig {
  std::string name;
  std::string plugin_id;
  config::Origin origin;
  const PluginManifest* manifest = nullptr;
  Params params;
};

/// A port of a component, with the topic it is bound to.
struct PortBinding {
  PortSpec spec;
  std::string topic;      // absolute: "/dental_lamp/arm/measured_js"
  config::Origin origin;  // of the rename, or of the component
  bool renamed = false;   // the file says which topic
};

/// What a fault of a component does: it ends the run, or it stays where it is, and only that
/// component is not activated any more.
enum class OnFault { stop, isolate };

/// One entry of `components:`, resolved, or one of the units that it is at run time.
struct ComponentConfig {
  std::string name;
  std::string unit{kMainUnit};  // of the component, when it is several
  config::Origin origin;
  std::string plugin_id;                     // as the user wrote it
  const PluginManifest* manifest = nullptr;  // of the component that runs (a host, for pure kinds)
  std::string topics;  // "left/" before the usual names of its topics; empty: nothing
  Params params;
  std::vector<SlotConfig> slots;
  std::vector<PortBinding> inputs, outputs;
  std::map<std::string, std::string> documents;  // section -> the bound entry's name
  std::string executor;
  std::string process;
  std::string host{kMainHost};
  Duration sim_latency{0};
  std::optional<OnFault> on_fault;  // as the file says, else as the graph does (on_fault.hpp)
  int place = 0;                    // in the graph, sources first

  /// The entry of `components:` that it is a unit of.
  std::string_view component() const {
    const std::string_view all{name};
    return unit == kMainUnit ? all : all.substr(0, all.size() - unit.size() - 1);
  }
};

/// What reaches an input from other processes of the deployment.
struct InputFromElsewhere {
  std::vector<const PortBinding*> outputs;  // that write its topic there
  std::set<std::string> processes;          // that have these
  /// Its samples have the numbers that their writer gave them. Where there are several writers, or
  /// other programs may write, they are counted as they come.
  bool is_numbered = false;
};

/// `goals:`: a metric of the summary that must not exceed its limit.
struct Goal {
  std::string metric;
  double limit;
  config::Origin origin, limit_origin;
};

/// `sweep_goals:`: what a metric must keep over many runs (`armature sweep`).
struct SweepGoal {
  enum class Statistic { median, p95, max, rms, share };
  std::string metric;
  Statistic statistic;
  std::optional<double> at_least, at_most;  // of the statistic
  double share_of = 0;                      // share: of the runs whose metric is at most this
  config::Origin origin;
};

/// A deployment file, read, checked and resolved against the plugins that are there.
struct DeploymentConfig {
  std::string name;
  bool simulated = false;
  int domain = 0;
  DdsConfig dds;
  std::uint64_t seed = 0;
  double time_limit_s = 0;   // 0: none
  double stop_within_s = 3;  // how long the end of a run waits for what moves to come to rest
  std::optional<RecordConfig> record;
  std::vector<ExecutorSpec> executors;
  std::map<std::string, std::map<std::string, config::Node>> documents;  // section -> name -> file
  std::vector<ComponentConfig> components;                               // in file order
  std::vector<Goal> goals;
  std::vector<SweepGoal> sweep_goals;
  std::string fingerprint;  // SHA-256 of the resolved file and of all documents
  config::Node file;        // with nothing left to defaults (completed_file.hpp)

  std::vector<std::string> processes() const;  // "main" first
  std::vector<std::string> hosts() const;      // "main" first
  /// What a part of it draws with: a number that differs between parts and follows `seed`.
  std::uint64_t seed_of(std::string_view part) const;
  /// The components with an output that is `measured`, in their order.
  std::vector<std::string> measuring() const;
  /// The place of `component` among them.
  int measuring_index(std::string_view component) const;
  /// The host that a process runs on.
  std::string host_of(std::string_view process) const;
  /// What reaches an input of a component in `process`; valid as long as `components`.
  InputFromElsewhere from_elsewhere(const PortBinding& input, std::string_view process) const;
};

/// False, and a problem, when `root` is another file. What that one says must not be told: it may
/// be any file that the user named by mistake.
bool check_is_deployment(const config::Node& root, config::Problems& problems);

/// Robots and rigs that a recording holds: "robots/arm".
using RecordedDocuments = std::map<std::string, config::Node>;

/// Reads `root` (a merged document). Every mistake that can be known without loading a library is
/// added to `problems`; the result is usable only when there is none. `recorded` documents stand
/// for the files that entries name, but for those that the command line names; null: files are
/// read.
DeploymentConfig read_deployment(const config::Node& root, const PluginRegistry& plugins,
                                 config::Problems& problems,
                                 const RecordedDocuments* recorded = nullptr);

}  // namespace armature
