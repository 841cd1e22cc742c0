// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/goals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "armature/config/reader.hpp"

namespace armature {
namespace {

/// What the plugin says of a metric; nullptr when it does not measure it.
const MetricSpec* find_metric(const PluginManifest& plugin, const std::string& metric) {
  const auto found = std::ranges::find(plugin.measures, metric, &MetricSpec::name);
  return found == plugin.measures.end() ? nullptr : &*found;
}

/// The plugins that measure it, or else the metrics that it may have been meant to be.
std::string hint(const std::string& metric, const DeploymentConfig& deployment,
                 const PluginRegistry& plugins) {
  std::vector<std::string> ids, known, known_here;
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (find_metric(plugin, metric)) ids.push_back(plugin.id);
    for (const MetricSpec& spec : plugin.measures) known.push_back(spec.name);
  }
  for (const ComponentConfig& component : deployment.components) {
    for (const MetricSpec& spec : component.manifest->measures) known_here.push_back(spec.name);
  }
  if (!ids.empty()) return fmt::format("; measured by {}", fmt::join(ids, ", "));
  return config::did_you_mean(metric, known_here.empty() ? known : known_here);
}

}  // namespace

std::vector<Goal> read_goals(const config::Node* section, config::Problems& problems) {
  std::vector<Goal> goals;
  if (!section) return goals;
  const config::MapReader map{*section, "goals", problems};  // notes what is no map
  for (const auto& entry : section->entries()) {
    // In the unit of its name, as the report tells it.
    const auto limit = config::to_number(entry.value);
    if (!limit) {
      problems.add(limit.error().origin,
                   config::in_quotes(entry.key) + " " + limit.error().message);
    }
    goals.push_back({entry.key, limit.value_or(0), entry.key_origin, entry.value.origin()});
  }
  return goals;
}

void check_goals(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems) {
  for (const Goal& goal : deployment.goals) {
    const MetricSpec* metric = nullptr;
    for (const ComponentConfig& component : deployment.components) {
      if (!metric) metric = find_metric(*component.manifest, goal.metric);
    }
    if (metric) {
      if (goal.limit < 0 && !metric->may_be_negative) {
        problems.add(goal.limit_origin,
                     fmt::format("the goal {:g} cannot be met: '{}' is never below 0", goal.limit,
                                 goal.metric));
      }
      continue;
    }
    problems.add(goal.origin, fmt::format("no component measures '{}'{}", goal.metric,
                                          hint(goal.metric, deployment, plugins)));
  }
}

}  // namespace armature
