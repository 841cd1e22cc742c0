// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/on_fault.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "armature/runtime/deployment_file/graph.hpp"

namespace armature {
namespace {

using Components = std::set<const ComponentConfig*>;

Components drivers_of(const DeploymentConfig& deployment) {
  Components drivers;
  for (const ComponentConfig& component : deployment.components) {
    if (is_driver(component)) drivers.insert(&component);
  }
  return drivers;
}

/// Who writes what one of `readers` reads.
Components feeding(const Components& readers, const DeploymentConfig& deployment) {
  Components writers;
  for (const ComponentConfig& component : deployment.components) {
    if (std::ranges::any_of(readers,
                            [&](const auto* one) { return reads_from(*one, component); })) {
      writers.insert(&component);
    }
  }
  return writers;
}

/// The drivers, and whatever they read from, directly or through others.
Components path_to_drivers(const DeploymentConfig& deployment) {
  Components path = drivers_of(deployment);
  for (std::size_t before = 0; before != path.size();) {
    before = path.size();
    path.merge(feeding(path, deployment));
  }
  return path;
}

bool is_isolated(const ComponentConfig& component) {
  return component.on_fault == OnFault::isolate;
}

/// Who shares the driver's executor and may delay it without need.
std::vector<std::string> strangers_beside(const ComponentConfig& driver,
                                          const DeploymentConfig& deployment) {
  const auto executor =
      std::ranges::find(deployment.executors, driver.executor, &ExecutorSpec::name);
  const bool paced = executor != deployment.executors.end() && executor->period;
  const Components needed =
      paced ? path_to_drivers(deployment) : feeding(drivers_of(deployment), deployment);
  std::vector<std::string> strangers;
  for (const ComponentConfig& other : deployment.components) {
    const bool beside =
        !is_driver(other) && other.executor == driver.executor && other.process == driver.process;
    if (beside && !needed.contains(&other)) strangers.push_back(other.name);
  }
  return strangers;
}

}  // namespace

bool is_driver(const ComponentConfig& component) { return component.manifest->driver.has_value(); }

bool commands_driver(const ComponentConfig& component, const DeploymentConfig& deployment) {
  return std::ranges::any_of(deployment.components, [&](const ComponentConfig& driver) {
    return is_driver(driver) && std::ranges::any_of(driver.inputs, [&](const PortBinding& input) {
             return input.spec.qos == QosProfile::command &&
                    has_topic(component.outputs, input.topic);
           });
  });
}

void decide_on_faults(DeploymentConfig& deployment) {
  const Components path = path_to_drivers(deployment);  // empty without a driver
  for (ComponentConfig& component : deployment.components) {
    if (component.on_fault) continue;
    const bool stops =
        path.empty() || path.contains(&component) || !component.manifest->measures.empty();
    component.on_fault = stops ? OnFault::stop : OnFault::isolate;
  }
}

void check_isolation(const DeploymentConfig& deployment, config::Problems& problems) {
  for (const ComponentConfig& component : deployment.components) {
    const bool commands = commands_driver(component, deployment);
    if (!is_isolated(component) || (!is_driver(component) && !commands)) continue;
    problems.add(component.origin,
                 fmt::format("component '{}' {}, and 'on_fault: isolate' would let the run go on "
                             "when it fails; leave 'on_fault' out, and its fault stops the run",
                             component.name,
                             is_driver(component) ? "moves an arm" : "commands what moves an arm"));
  }
}

std::vector<std::string> isolation_warnings(const DeploymentConfig& deployment) {
  std::vector<std::string> warnings;
  const Components path = path_to_drivers(deployment);
  for (const ComponentConfig& component : deployment.components) {
    if (!is_isolated(component) || !path.contains(&component)) continue;
    warnings.push_back(
        fmt::format("component '{}' leads to what moves an arm, and is isolated: when it fails, "
                    "the run goes on without it; leave 'on_fault' out, and its fault stops the run",
                    component.name));
  }
  return warnings;
}

bool stops_run(const ComponentConfig& component) {
  return component.on_fault.value_or(OnFault::stop) == OnFault::stop;
}

bool hang_stops_run(const ComponentConfig& component, const DeploymentConfig& deployment) {
  return !deployment.simulated && stops_run(component);
}

bool stops_run(const std::string& process, const DeploymentConfig& deployment) {
  return std::ranges::any_of(deployment.components, [&](const ComponentConfig& component) {
    return component.process == process && component.on_fault == OnFault::stop;
  });
}

std::vector<std::string> executor_warnings(const DeploymentConfig& deployment) {
  std::vector<std::string> warnings;
  if (deployment.simulated) return warnings;  // there are no executors in lockstep
  for (const ComponentConfig& driver : deployment.components) {
    if (!is_driver(driver)) continue;
    const auto strangers = strangers_beside(driver, deployment);
    if (strangers.empty()) continue;
    warnings.push_back(
        fmt::format("component '{}' moves an arm and shares the executor '{}' with {}: when a step "
                    "of theirs is long or hangs, the arm waits; name another executor for them",
                    driver.name, driver.executor, fmt::join(strangers, ", ")));
  }
  return warnings;
}

}  // namespace armature
