// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/open_inputs.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "armature/config/conversion.hpp"

namespace armature {
namespace {

using config::Node;

void open_input(const Node& item, DeploymentConfig& deployment, config::Problems& problems) {
  const auto wanted = config::to_text(item);
  if (!wanted) {
    problems.add(item.origin(),
                 fmt::format("'open' lists inputs as component.port, not {}", item.describe()));
    return;
  }
  std::vector<std::string> names;
  for (ComponentConfig& component : deployment.components) {
    for (PortBinding& input : component.inputs) {
      names.push_back(fmt::format("{}.{}", component.name, input.spec.name));
      if (names.back() != *wanted) continue;
      if (input.spec.qos != QosProfile::command) {
        input.spec.outside = true;
        return;
      }
      problems.add(item.origin(),
                   fmt::format("'{}' takes commands, which come from the deployment itself only; "
                               "open an input of a component that decides, and let that one "
                               "command",
                               *wanted));
      return;
    }
  }
  problems.add(item.origin(), fmt::format("no component has the input '{}'{}", *wanted,
                                          config::did_you_mean(*wanted, names)));
}

}  // namespace

void open_inputs(const Node* list, DeploymentConfig& deployment, config::Problems& problems) {
  if (!list) return;
  if (list->kind() != Node::Kind::sequence) {
    problems.add(
        list->origin(),
        fmt::format("'open' must be a list of inputs, [task.target], not {}", list->describe()));
    return;
  }
  for (const Node& item : list->items()) open_input(item, deployment, problems);
}

}  // namespace armature
