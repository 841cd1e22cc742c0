// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "run/run.hpp"

namespace armature {

/// `armature run --host NAME`, on another host than the main one: waits for the main process,
/// measures how far its clock is ahead, starts the processes of this host, and passes on what they
/// and the main process say to each other. When the main process falls silent they come to rest and
/// end. Exit code 0 when the main process has ended all of them, and all ended well.
int run_host(const RunOptions& options, const DeploymentConfig& deployment, int domain,
             PluginRegistry& plugins);

}  // namespace armature
