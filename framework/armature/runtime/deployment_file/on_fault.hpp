// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// Decides of every component that the file says nothing of what its fault does. It ends the run
/// when a path over topics leads from the component to a driver, when it measures what the run is
/// judged by, and where there is no driver at all; else it is isolated.
void decide_on_faults(DeploymentConfig& deployment);

/// Whether the component moves an arm: `driver:` in its plugin.yaml.
bool is_driver(const ComponentConfig& component);
/// Whether it writes an input of a driver that takes commands.
bool commands_driver(const ComponentConfig& component, const DeploymentConfig& deployment);

/// Refuses `on_fault: isolate` of a driver and of what writes commands to one: the run would go on
/// without it, and only the driver's lease, or nothing, would stop the arm.
void check_isolation(const DeploymentConfig& deployment, config::Problems& problems);

/// A line for the operator for everything else that leads to a driver and is isolated.
std::vector<std::string> isolation_warnings(const DeploymentConfig& deployment);

/// Whether a fault of the component ends the run. What the runtime itself adds does.
bool stops_run(const ComponentConfig& component);

/// Whether a step of the component that does not return ends the run. In lockstep it is only told:
/// how fast time goes there is the machine's affair, and must not change what happens.
bool hang_stops_run(const ComponentConfig& component, const DeploymentConfig& deployment);

/// Whether the loss of a process ends the run: it holds a component of the file whose fault does.
/// What the runtime itself adds to every process does not count.
bool stops_run(const std::string& process, const DeploymentConfig& deployment);

/// For every driver that shares its executor with components that have no business there, a line
/// for the operator: those that lead to no driver, and where the executor has no period all but
/// those that a driver reads from.
std::vector<std::string> executor_warnings(const DeploymentConfig& deployment);

}  // namespace armature
