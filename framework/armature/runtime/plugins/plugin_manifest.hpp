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

namespace armature ARMATURE_EXPORT {

/// What two clocks that are meant to be the same may differ by.
inline constexpr Duration kMaxAhead = seconds(0.1);

/// The unit of a component that its ports and slots belong to unless they say otherwise.
inline constexpr std::string_view kMainUnit = "main";

/// A component may be several units at run time, each with ports, slots, an inbox and a thread of
/// its own: one for what must never wait, another for what takes its time.
struct UnitSpec {
  std::string name;                  // "planner": of the component `motion` it is `motion.planner`
  std::optional<Duration> max_step;  // as PluginManifest::max_step
  std::string doc;
};

/// What follows when nothing is heard on an input for a time.
struct LeaseSpec {
  Duration after{0};
  std::string param;  // the plugin's parameter that tells how long instead; empty: `after` does
  std::string then;   // what happens then
};

/// An input or output as plugin.yaml declares it.
struct PortSpec {
  std::string name;
  std::string type;   // ROS name: "sensor_msgs/JointState"
  std::string topic;  // default, relative to the deployment's name
  std::string frame;  // the frame its poses are in; empty: none
  std::string of;     // "robot": its joints and its base are those of its component's robot
  std::string doc;
  std::vector<std::string> units{std::string{kMainUnit}};  // that have it
  QosProfile qos = QosProfile::state;
  config::Origin origin;

  // Inputs only.
  std::optional<int> queue;         // reads: queue(n); none: reads: latest
  bool trigger = false;             // a new sample activates the component
  bool join = false;                // shown only together, with equal header.stamp
  bool optional = false;            // nobody needs to write it
  bool outside = false;             // other programs may write it; or so says `open:`
  bool feedback = false;            // an arrow against the flow, read a cycle late
  std::optional<Duration> max_age;  // older samples are not shown
  Duration max_ahead = kMaxAhead;   // nor those that are stamped farther ahead of now
  std::optional<LeaseSpec> lease;   // with max_age there is one always

  // Outputs only.
  bool shared = false;    // other components may write the topic too, as ROS does with /tf
  bool measured = false;  // a measurement of the time in its stamp, that others react to
};

/// A place in a component where a plugin of a kind sits.
struct SlotSpec {
  std::string name;
  std::string kind;
  std::string otherwise;  // the plugin that sits there when a deployment names none; empty: it must
  bool optional = false;  // unless it may stay empty
  std::string doc;
  std::vector<std::string> units{std::string{kMainUnit}};  // each has an instance of its own
};

/// A word that one plugin requires and another one provides, "time_law". The words mean something
/// to their plugins, nothing to the runtime.
struct Capability {
  std::string word;
  std::string when;  // only while this parameter is not 0 or false; empty: always
  std::string doc;
};

/// "unless 'segment_s' is 0"; empty for a capability that always holds.
std::string unless_text(const Capability& capability, const std::vector<ParamSpec>& params);

/// A figure that a component reports to the summary of a run.
struct MetricSpec {
  std::string name;  // ends in its unit: "distance_error_mm"
  std::string doc;
  bool may_be_negative = false;  // a ratio in dB, a signed lag; a goal for any other is not below 0
};

/// What a component that moves an arm says of what it moves: the one that everything else stops
/// for.
struct DriverSpec {
  bool simulated = false;  // it moves no metal
  std::string device;  // the parameter that names the device; empty: there is one in a deployment
};

/// Everything that can be known of a plugin without running its code: its plugin.yaml.
struct PluginManifest {
  std::string id;
  std::string kind;   // "component", or a pure kind
  std::string hosts;  // the pure kind that this component runs alone on topics
  std::string doc;
  bool allocates = false;
  bool uses_files = false;  // besides its parameters: no replay repeats it
  bool pure = true;  // false: equal input may give other output, so no place on the simulated clock
  bool runs_programs = false;        // starts a program that a parameter names
  std::vector<std::string> uses;     // "robot", "rig"
  std::vector<std::string> may_use;  // the same, where the deployment has one
  std::vector<ParamSpec> params;
  std::vector<UnitSpec> units;  // beside the main one
  std::vector<SlotSpec> slots;
  std::vector<Capability> required, provided;
  std::vector<MetricSpec> measures;
  std::optional<DriverSpec> driver;  // of a component that moves an arm
  std::optional<Duration> max_step;  // of a component: a step that takes longer hangs
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
