// SPDX-License-Identifier: Apache-2.0
#include "run/joint_reports.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/graph.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"

namespace armature {
namespace {

using config::Node;

const PortBinding* find_type(const std::vector<PortBinding>& ports, std::string_view type) {
  const auto found =
      std::ranges::find(ports, type, [](const auto& port) { return port.spec.type; });
  return found == ports.end() ? nullptr : &*found;
}

/// The topics of the report's inputs: the arm's, and of the motion that commands it the goals.
std::vector<std::pair<std::string, std::string>> topics_for(const ComponentConfig& arm,
                                                            const DeploymentConfig& deployment) {
  std::vector<std::pair<std::string, std::string>> topics;
  const auto add = [&](const char* input, const PortBinding* port) {
    if (port) topics.emplace_back(input, port->topic);
  };
  add("measured_js", find_port(arm.outputs, "measured_js"));
  const PortBinding* command = find_port(arm.inputs, "servo_jp");
  const ComponentConfig* motion = command ? writer_of(command->topic, deployment) : nullptr;
  if (!motion) return topics;
  add("servo_jp", command);
  add("goal", find_type(motion->inputs, "armature_msgs/MotionGoal"));
  add("status", find_type(motion->outputs, "armature_msgs/MotionStatus"));
  return topics;
}

/// A name out of a deployment as part of a file's name.
std::string as_file_name(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_' && c != '.'; },
      '_');
  return name;
}

/// Without the ending.
std::string file_name_for(const ComponentConfig& arm) { return as_file_name(arm.name) + "_joints"; }

/// What a user would write for it.
Node::Entry entry_for(const ComponentConfig& arm, const DeploymentConfig& deployment,
                      const std::filesystem::path& folder) {
  const config::Origin& origin = arm.origin;
  const auto text = [&](std::string value) { return Node::scalar(std::move(value), true, origin); };
  const auto map = [&](const std::vector<std::pair<std::string, std::string>>& pairs) {
    std::vector<Node::Entry> entries;
    for (const auto& [key, value] : pairs) entries.push_back({key, origin, text(value)});
    return Node::map(std::move(entries), origin);
  };
  const std::string name = arm.name + ".joints";
  const std::filesystem::path file = folder / file_name_for(arm);
  std::vector<Node::Entry> entries;
  entries.push_back({"plugin", origin, text("report/joints")});
  entries.push_back({"robot", origin, text(arm.documents.at("robots"))});
  entries.push_back({"executor", origin, text(name)});
  entries.push_back({"params", origin, map({{"file", file.string()}})});
  entries.push_back({"in", origin, map(topics_for(arm, deployment))});
  return {name, origin, Node::map(std::move(entries), origin)};
}

bool is_reported(const ComponentConfig& component) {
  return is_driver(component) && component.documents.contains("robots") &&
         find_port(component.outputs, "measured_js");
}

}  // namespace

void add_joint_reports(DeploymentConfig& deployment, const PluginRegistry& plugins,
                       const std::filesystem::path& folder) {
  std::vector<Node::Entry> entries;
  for (const ComponentConfig& component : deployment.components) {
    if (is_reported(component)) entries.push_back(entry_for(component, deployment, folder));
  }
  config::Problems problems;
  for (const Node::Entry& entry : entries) {
    deployment.executors.push_back({.name = entry.key, .period = {}});
    auto report = ComponentReader{deployment, plugins, problems}.read(entry);
    if (!report) continue;
    report->on_fault = OnFault::isolate;
    // After all others: what they do at an instant, in lockstep, does not depend on it.
    report->place = static_cast<int>(deployment.components.size());
    deployment.components.push_back(std::move(*report));
  }
  problems.throw_if_any();
}

std::vector<std::string> joint_tables(const DeploymentConfig& deployment) {
  std::vector<std::string> tables;
  for (const ComponentConfig& component : deployment.components) {
    if (is_reported(component)) tables.push_back(file_name_for(component) + ".csv");
  }
  return tables;
}

}  // namespace armature
