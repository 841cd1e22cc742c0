// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/bus/qos.hpp"
#include "armature/config/params.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// An input or output as plugin.yaml declares it.
struct PortSpec {
  std::string name;
  std::string type;   // ROS name: "sensor_msgs/JointState"
  std::string topic;  // default, relative to the deployment's name
  std::string frame;  // the frame its poses are in; empty: none
  std::string of;     // "robot": its joints and its base are those of its component's robot
  std::string doc;
  QosProfile qos = QosProfile::state;
  config::Origin origin;

  // Inputs only.
  std::optional<int> queue;         // reads: queue(n); none: reads: latest
  bool trigger = false;             // a new sample activates the component
  bool join = false;                // shown only together, with equal header.stamp
  bool optional = false;            // nobody needs to write it
  bool outside = false;             // fed by programs that are not part of the deployment
  bool feedback = false;            // an arrow against the flow, read a cycle late
  std::optional<Duration> max_age;  // older samples are not shown

  // Outputs only.
  bool shared = false;  // other components may write the topic too, as ROS does with /tf
};

/// A place in a component where a plugin of a kind sits.
struct SlotSpec {
  std::string name;
  std::string kind;
  std::string doc;
};

/// A word that one plugin needs and another one offers, "time_law". The words mean something to
/// their plugins, nothing to the runtime.
struct Trait {
  std::string word;
  std::string when;  // only while this parameter is not 0 or false; empty: always
  std::string doc;
};

/// "unless 'segment_s' is 0"; empty for a trait that always holds.
std::string unless_text(const Trait& trait, const std::vector<ParamSpec>& params);

/// A figure that a component reports to the summary of a run.
struct MetricSpec {
  std::string name;  // ends in its unit: "distance_error_mm"
  std::string doc;
};

/// Everything that can be known of a plugin without running its code: its plugin.yaml.
struct PluginManifest {
  std::string id;
  std::string kind;   // "component", or a pure kind
  std::string hosts;  // the pure kind that this component runs alone on topics
  std::string doc;
  bool allocates = false;
  bool pure = true;  // false: equal input may give other output, so no place on the simulated clock
  std::vector<std::string> uses;     // "robot", "rig"
  std::vector<std::string> may_use;  // the same, where the deployment has one
  std::vector<ParamSpec> params;
  std::vector<SlotSpec> slots;
  std::vector<Trait> needs, offers;
  std::vector<MetricSpec> measures;
  std::vector<PortSpec> inputs, outputs;

  std::filesystem::path file;  // the library
  std::string abi;             // its ABI tag
};

/// Parses the text of a plugin.yaml; `name` stands for the file in messages.
PluginManifest parse_manifest(std::string_view yaml, std::string_view name,
                              config::Problems& problems);

/// The manifest of a component that is part of the runtime. Throws config::ConfigError.
PluginManifest parse_own_manifest(std::string_view yaml);

}  // namespace armature
