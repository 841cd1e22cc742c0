// SPDX-License-Identifier: Apache-2.0
#include "drill/drilled_deployment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/deployment_file/graph.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "exit_code.hpp"
#include "run/named_deployment.hpp"

namespace armature::drill {
namespace {

constexpr std::string_view kMeasured = "measured_js";

/// An entry of the file, and not one of the further units that it is at run time.
bool is_entry(const ComponentConfig& component) { return component.unit == kMainUnit; }

const PortBinding& measured_of(const ComponentConfig& driver) {
  for (const PortBinding& output : driver.outputs) {
    if (output.spec.name == kMeasured && output.spec.type == "sensor_msgs/JointState") {
      return output;
    }
  }
  throw InvalidChoice(
      fmt::format("'{}' ({}) has no output {} of type sensor_msgs/JointState; a drill judges an "
                  "arm by its own samples",
                  driver.name, driver.manifest->id, kMeasured));
}

void check_hosts(const DeploymentConfig& deployment) {
  std::string settings;
  for (const ComponentConfig& component : deployment.components) {
    if (component.host == kMainHost || component.unit != kMainUnit) continue;
    settings += fmt::format(" --set components.{}.host={}", component.name, kMainHost);
  }
  if (settings.empty()) return;
  throw InvalidChoice("the deployment has other hosts, and a drill runs on one machine:" +
                      settings);
}

void check_simulated(const DeploymentConfig& deployment) {
  bool any = false;
  for (const ComponentConfig& component : deployment.components) {
    if (!is_driver(component)) continue;
    any = true;
    if (component.manifest->driver->simulated) continue;
    throw InvalidChoice(
        fmt::format("'{}' ({}) moves metal, and a drill kills a moving machine; only deployments "
                    "whose drivers are all 'simulated: true' in plugin.yaml are drilled",
                    component.name, component.manifest->id));
  }
  if (any) return;
  throw InvalidChoice(fmt::format(
      "deployment '{}' has no component with 'driver:' in its plugin.yaml: there is no arm to stop",
      deployment.name));
}

std::vector<JointLimit> limits_of(const ComponentConfig& driver,
                                  const DeploymentConfig& deployment) {
  const auto bound = driver.documents.find("robots");
  if (bound == driver.documents.end()) {
    throw InvalidChoice(
        fmt::format("'{}' ({}) moves an arm and is bound to no robot, whose limits "
                    "a drill judges it by: 'uses: [robot]' in plugin.yaml",
                    driver.name, driver.manifest->id));
  }
  const RobotModel model = read_robot_model(deployment.documents.at("robots").at(bound->second));
  std::vector<JointLimit> limits;
  for (const Joint& joint : model.joints()) limits.push_back({joint.name, joint.max_velocity});
  return limits;
}

std::vector<HeedsPendant> heed_pendants(const DeploymentConfig& deployment) {
  std::vector<HeedsPendant> heed;
  for (const ComponentConfig& component : deployment.components) {
    const PortBinding* hold = find_port(component.inputs, "hold_to_run");
    const PortBinding* rearm = find_port(component.inputs, "rearm");
    if (!hold || !rearm || writer_of(hold->topic, deployment) ||
        writer_of(rearm->topic, deployment)) {
      continue;
    }
    heed.push_back(
        {.name = component.name, .hold_topic = hold->topic, .rearm_topic = rearm->topic});
  }
  return heed;
}

/// The inputs that somebody of the deployment writes and nobody else may.
std::vector<TopicSpec> inputs_of(const DeploymentConfig& deployment,
                                 const std::vector<DrilledArm>& arms) {
  std::set<std::string> written, taken;
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& output : component.outputs) written.insert(output.topic);
  }
  for (const DrilledArm& arm : arms) taken.insert(arm.measured_topic);
  std::vector<TopicSpec> inputs;
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& input : component.inputs) {
      const MessageType* type = find_message_type(input.spec.type);
      const bool own = written.contains(input.topic) && !input.spec.outside;
      if (!own || !type || !taken.insert(input.topic).second) continue;
      inputs.push_back({.name = "rt" + input.topic, .type = type, .qos = input.spec.qos});
    }
  }
  return inputs;
}

/// Settings that leave out the reports: a report ends the run when the task gives up. Nothing else
/// changes where nobody reads what the report writes.
std::vector<std::string> without_reports(const DeploymentConfig& deployment) {
  std::vector<std::string> settings;
  for (const ComponentConfig& report : deployment.components) {
    const bool is_read =
        std::ranges::any_of(deployment.components, [&](const ComponentConfig& component) {
          return component.name != report.name && reads_from(component, report);
        });
    const bool only_measures = !report.manifest->measures.empty() && !is_driver(report) && !is_read;
    if (!is_entry(report) || !only_measures) continue;
    settings.push_back(fmt::format("components.{}=null", report.name));
  }
  if (!settings.empty() && !deployment.goals.empty()) settings.emplace_back("goals=null");
  if (!settings.empty() && !deployment.sweep_goals.empty()) {
    settings.emplace_back("sweep_goals=null");
  }
  return settings;
}

/// Where somebody of the deployment moves it by hand; empty where nobody does.
std::string hand_of(const ComponentConfig& driver, const DeploymentConfig& deployment) {
  const PortBinding* hand = find_port(driver.inputs, "hand_js");
  const bool is_told = hand && hand->spec.type == "sensor_msgs/JointState";
  return is_told && writer_of(hand->topic, deployment) ? hand->topic : std::string{};
}

/// Where its power is switched; empty where it has no such input or the deployment switches it.
std::string power_of(const ComponentConfig& driver, const DeploymentConfig& deployment) {
  const PortBinding* power = find_port(driver.inputs, "power");
  const bool takes_switch = power && power->spec.outside && power->spec.type == "std_msgs/Bool" &&
                            power->spec.qos == QosProfile::latched;
  return takes_switch && !writer_of(power->topic, deployment) ? power->topic : std::string{};
}

/// Puts entries of the file into processes of their own.
class Splitter {
 public:
  explicit Splitter(DrilledDeployment& drilled) : drilled_{&drilled} {}

  /// Components that tell figures of the run (`measures:`) stay in the main process.
  std::string put(const ComponentConfig& component, const std::string& process) {
    if (!component.manifest->measures.empty()) return std::string{kMainProcess};
    drilled_->apart.push_back(fmt::format("components.{}.process={}", component.name, process));
    if (std::ranges::find(drilled_->processes, process) == drilled_->processes.end()) {
      drilled_->processes.push_back(process);
    }
    if (stops_run(component)) drilled_->ending.insert(process);
    return process;
  }

 private:
  DrilledDeployment* drilled_;
};

}  // namespace

std::string_view to_string(Form form) { return form == Form::single ? "single" : "split"; }

DrilledDeployment read_drilled(const DeploymentSource& source, const PluginRegistry& plugins) {
  const DeploymentConfig deployment = read_named(source, plugins);
  check_hosts(deployment);
  check_simulated(deployment);
  DrilledDeployment drilled{.name = deployment.name,
                            .stop_within_s = deployment.stop_within_s,
                            .records = deployment.record.has_value()};
  Splitter splitter{drilled};
  std::set<std::string> arm_executors;
  for (const ComponentConfig& component : deployment.components) {
    if (is_driver(component)) arm_executors.insert(component.executor);
  }
  const auto keep = [&](DrilledComponent& as, const ComponentConfig& component,
                        const std::string& process) {
    if (as.name.empty()) {
      as = {.name = component.name,
            .process = process,
            .shares_arm_thread = arm_executors.contains(component.executor)};
    }
  };
  for (const ComponentConfig& component : deployment.components) {
    if (!is_entry(component)) continue;
    if (is_driver(component)) {
      drilled.arms.push_back({.component = component.name,
                              .process = splitter.put(component, "drill_" + component.name),
                              .measured_topic = measured_of(component).topic,
                              .hand_topic = hand_of(component, deployment),
                              .power_topic = power_of(component, deployment),
                              .limits = limits_of(component, deployment)});
    } else if (commands_driver(component, deployment)) {
      const std::string process = splitter.put(component, "drill_" + component.name);
      if (component.slots.empty()) continue;
      keep(drilled.commander, component, process);
      drilled.commanders.push_back(component.name);
    } else if (!component.manifest->hosts.empty()) {
      keep(drilled.perception, component, splitter.put(component, "drill_perception"));
    } else if (!stops_run(component)) {
      keep(drilled.monitor, component, splitter.put(component, "drill_monitor"));
    }
  }
  drilled.heed_pendants = heed_pendants(deployment);
  drilled.unreported = without_reports(deployment);
  drilled.inputs = inputs_of(deployment, drilled.arms);
  return drilled;
}

}  // namespace armature::drill
