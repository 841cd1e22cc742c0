// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/processes/child_processes.hpp"
#include "run/run.hpp"

namespace armature {

/// Whether the processes of a run measure how late and how long its steps are: for the operator, or
/// for the figures in the recording.
bool wants_timing(const RunOptions& options, const DeploymentConfig& config);

/// The command line of another process of the deployment, without the program.
std::vector<std::string> process_arguments(const RunOptions& options, int domain,
                                           const std::string& process,
                                           const RunOptions::Origin& origin);

/// Starts the other processes of the main host. Before this one joins DDS.
void start_processes(ChildProcesses& children, const RunOptions& options,
                     const DeploymentConfig& config, int domain, const RunOptions::Origin& origin);

/// Waits for the agents of the other hosts from now on. After `deployment` has joined DDS, and
/// `children` must go before it.
void expect_hosts(ChildProcesses& children, const RunOptions& options, Deployment& deployment,
                  const RunOptions::Origin& origin);

}  // namespace armature
