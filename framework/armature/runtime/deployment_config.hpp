// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/params.hpp"
#include "armature/runtime/executor.hpp"
#include "armature/runtime/plugin_manifest.hpp"
#include "armature/runtime/plugin_registry.hpp"

namespace armature {

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

/// One entry of `components:`, resolved.
struct ComponentConfig {
  std::string name;
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
  Duration sim_latency{0};
  int place = 0;  // in the graph, sources first
};

/// `goals:`: a metric of the summary that must not exceed its limit.
struct Goal {
  std::string metric;
  double limit;
  config::Origin origin;
};

/// A deployment file, read, checked and resolved against the plugins that are there.
struct DeploymentConfig {
  std::string name;
  bool simulated = false;
  int domain = 0;
  std::uint64_t seed = 0;
  double time_limit_s = 0;  // 0: none
  std::vector<ExecutorSpec> executors;
  std::map<std::string, std::map<std::string, config::Node>> documents;  // section -> name -> file
  std::vector<ComponentConfig> components;                               // in file order
  std::vector<Goal> goals;
  std::string fingerprint;  // of the resolved file

  std::vector<std::string> processes() const;  // "main" first
};

inline constexpr std::string_view kMainProcess = "main";
inline constexpr std::string_view kMainExecutor = "main";
// The runtime's own components, which every process has (the clock: on the simulated clock).
inline constexpr std::string_view kStateComponent = "runtime";
inline constexpr std::string_view kClockComponent = "runtime_clock";

/// Reads `root` (a merged document). Every mistake that can be known without loading a library is
/// added to `problems`; the result is usable only when there is none.
DeploymentConfig read_deployment(const config::Node& root, const PluginRegistry& plugins,
                                 config::Problems& problems);

}  // namespace armature
