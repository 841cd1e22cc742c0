// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "armature/bus/transport.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "drill/arm_record.hpp"
#include "run/run.hpp"

namespace armature::drill {

/// One process, or every arm, what commands it, what it sees and what only watches apart.
enum class Form { single, split };
std::string_view to_string(Form form);

struct DrilledArm {
  std::string component;
  std::string process;         // its own, in the split form
  std::string measured_topic;  // where it tells where it is: sensor_msgs/JointState
  std::string hand_topic;      // where a hand of the deployment says where it moves it; or empty
  std::string power_topic;     // where its drives' power is switched: std_msgs/Bool; empty: nowhere
  std::vector<JointLimit> limits;
};

/// A component that a fault may meet. Empty name: the deployment has none.
struct DrilledComponent {
  std::string name;
  std::string process;             // in the split form
  bool shares_arm_thread = false;  // in the single form: a step that hangs halts the arm's, too
};

/// A component that heeds an operator's buttons where somebody writes them, as motion does. Here
/// nobody does.
struct HeedsPendant {
  std::string name;
  std::string hold_topic, rearm_topic;
};

/// A deployment, as far as its drill needs to know it.
struct DrilledDeployment {
  std::string name;
  double stop_within_s = 0;
  bool records = false;  // its runs, which a drill's do not
  std::vector<DrilledArm> arms;
  DrilledComponent commander;           // that arms take commands from: motion
  std::vector<std::string> commanders;  // all of them
  DrilledComponent perception;          // a pure plugin that runs alone: what is seen
  DrilledComponent monitor;             // whose fault does not end the run
  std::vector<HeedsPendant> heed_pendants;
  std::vector<TopicSpec> inputs;   // that the deployment itself feeds, but for the arms' samples
  std::vector<std::string> apart;  // --set: the split form
  std::vector<std::string> unreported;  // --set: without reports, which end a run
  std::vector<std::string> processes;   // of the split form, beside main
  std::set<std::string> ending;         // of these, whose loss ends the run
};

/// Reads the deployment. Throws config::ConfigError, or InvalidChoice when one of its drivers moves
/// metal, cannot be heard, or when it has none.
DrilledDeployment read_drilled(const DeploymentSource& source, const PluginRegistry& plugins);

}  // namespace armature::drill
