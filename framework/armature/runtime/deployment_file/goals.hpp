// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// Reads `goals:`, a map from metrics to their limits; null: none.
std::vector<Goal> read_goals(const config::Node* section, config::Problems& problems);

/// A goal that would never be met is a problem: for a metric that no component measures, with the
/// metrics that are measured, or the plugins that would measure it; and below 0 for a metric that
/// is never negative.
void check_goals(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems);

}  // namespace armature
