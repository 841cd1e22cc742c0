// SPDX-License-Identifier: Apache-2.0
#include "inspect/inspect.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "armature/config/document.hpp"
#include "armature/config/source_text.hpp"
#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment_file/completed_file.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "inspect/graph_drawing.hpp"
#include "inspect/leases.hpp"
#include "inspect/origin_json.hpp"
#include "run/named_deployment.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

DrawnGraph graph_of(const DeploymentConfig& deployment) {
  DrawnGraph graph{.deployment = deployment.name};
  for (const auto& component : deployment.components) {
    graph.components.push_back({component.name, component.plugin_id, component.process});
    for (const auto& port : component.outputs) {
      graph.topics[port.topic].type = port.spec.type;
      graph.topics[port.topic].writers.push_back(component.name);
    }
    for (const auto& port : component.inputs) {
      graph.topics[port.topic].type = port.spec.type;
      graph.topics[port.topic].readers.push_back({component.name, port.spec.feedback});
    }
  }
  return graph;
}

/// What a fault of each component does, as a comment of YAML.
std::string on_fault_comment(const DeploymentConfig& deployment) {
  std::string stop, isolate;
  for (const auto& component : deployment.components) {
    (stops_run(component) ? stop : isolate) += " " + component.name;
  }
  std::string text = fmt::format("# a fault of these ends the run:{}\n", stop);
  if (!isolate.empty()) text += fmt::format("# of these it stays where it is:{}\n", isolate);
  return text;
}

void print_tree(const config::Node& tree, bool json) {
  if (json) {
    print_out("{}\n", json_text(with_origins(tree)));
  } else {
    print_out("{}", config::to_yaml(tree, true));
  }
}

}  // namespace

int show_deployment(const DeploymentSource& source, bool json) {
  const config::PipeTimeLimit one_for_all;
  const config::Node root = load_named(source);
  config::Problems problems;
  check_is_deployment(root, problems);
  problems.throw_if_any();
  const PluginRegistry plugins;
  print_tree(completed_file(root, plugins), json);
  if (json) return kOk;
  const DeploymentConfig deployment = read_deployment(root, plugins, problems);
  if (problems.empty()) {
    print_out("{}{}", on_fault_comment(deployment), leases_comment(deployment));
  } else {
    print_out("# who waits for whom is not told: armature check names what is wrong, {} in all\n",
              problems.sorted().size());
  }
  return kOk;
}

int graph_deployment(const DeploymentSource& source, GraphFormat format) {
  const PluginRegistry plugins;
  print_out("{}", drawing_of(graph_of(read_named(source, plugins)), format));
  return kOk;
}

}  // namespace armature
