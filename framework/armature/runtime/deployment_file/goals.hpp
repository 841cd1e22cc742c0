// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// Reads `goals:`, a map from metrics to their limits; null: none.
std::vector<Goal> read_goals(const config::Node* section, config::Problems& problems);

/// Reads `sweep_goals:`, a map from metrics to what each of their statistics must keep; null: none.
std::vector<SweepGoal> read_sweep_goals(const config::Node* section, const std::vector<Goal>& goals,
                                        config::Problems& problems);
/// "p95".
std::string_view to_string(SweepGoal::Statistic statistic);

/// A goal that would never be met is a problem: for a metric that no component measures, with the
/// metrics that are measured, or the plugins that would measure it; and below 0 for a metric that
/// is never negative.
void check_goals(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems);

}  // namespace armature
