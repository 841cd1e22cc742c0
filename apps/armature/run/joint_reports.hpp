// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// Adds a `report/joints` for every arm of the deployment: for every driver that tells
/// `measured_js`. It writes `<arm>_joints.csv` and `.svg` into `folder`, is called `<arm>.joints`,
/// reads the arm's own topics and those of the motion that commands it, and has a thread of its
/// own; a fault of it stays where it is. The fingerprint stays what it was: nothing that the
/// deployment's other processes do depends on it. Throws config::ConfigError.
void add_joint_reports(DeploymentConfig& deployment, const PluginRegistry& plugins,
                       const std::filesystem::path& folder);

/// The tables that those write, by their names in the folder.
std::vector<std::string> joint_tables(const DeploymentConfig& deployment);

}  // namespace armature
