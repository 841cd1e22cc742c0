// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/goals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

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

constexpr std::array kStatistics{SweepGoal::Statistic::median, SweepGoal::Statistic::p95,
                                 SweepGoal::Statistic::max, SweepGoal::Statistic::rms,
                                 SweepGoal::Statistic::share};

/// The only number is the limit of what should be small, or of a share, which should be large.
void read_bounds(const config::Node& node, SweepGoal& goal, config::Problems& problems) {
  const bool is_pair = node.kind() == config::Node::Kind::sequence;
  if (is_pair && node.items().size() != 2) {
    return problems.add(node.origin(), fmt::format("'{}' takes a number or [least, most]",
                                                   to_string(goal.statistic)));
  }
  const auto number = [&](const config::Node& value) {
    const auto read = config::to_number(value);
    if (!read) problems.add(read.error().origin, "a bound " + read.error().message);
    return read.value_or(0);
  };
  if (is_pair) {
    goal.at_least = number(node.items()[0]);
    goal.at_most = number(node.items()[1]);
    if (*goal.at_least > *goal.at_most) {
      problems.add(node.origin(), fmt::format("nothing is at least {:g} and at most {:g}",
                                              *goal.at_least, *goal.at_most));
    }
  } else if (goal.statistic == SweepGoal::Statistic::share) {
    goal.at_least = number(node);
  } else {
    goal.at_most = number(node);
  }
  const bool is_share = goal.statistic == SweepGoal::Statistic::share;
  if (is_share && (*goal.at_least < 0 || goal.at_most.value_or(*goal.at_least) > 1)) {
    problems.add(node.origin(), "a share is from 0 to 1");
  }
}

/// What is counted for a share: what the entry says, or the limit of a single run.
double read_share_of(config::MapReader& map, const std::string& metric,
                     const std::vector<Goal>& goals, bool has_share) {
  if (const auto given = map.optional_number("at_most")) {
    if (!has_share) map.problem("at_most", "'at_most' is what 'share' counts, and there is none");
    return *given;
  }
  const auto goal = std::ranges::find(goals, metric, &Goal::metric);
  if (goal != goals.end()) return goal->limit;
  if (has_share) {
    map.problem("share", fmt::format("'share' needs 'at_most', as '{}' has no goal", metric));
  }
  return 0;
}

void check_metric(const std::string& metric, const config::Origin& origin,
                  const DeploymentConfig& deployment, const PluginRegistry& plugins,
                  config::Problems& problems) {
  for (const ComponentConfig& component : deployment.components) {
    if (find_metric(*component.manifest, metric)) return;
  }
  problems.add(origin, fmt::format("no component measures '{}'{}", metric,
                                   hint(metric, deployment, plugins)));
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

std::string_view to_string(SweepGoal::Statistic statistic) {
  constexpr std::array<std::string_view, kStatistics.size()> kNames{"median", "p95", "max", "rms",
                                                                    "share"};
  return kNames[static_cast<std::size_t>(statistic)];
}

std::vector<SweepGoal> read_sweep_goals(const config::Node* section, const std::vector<Goal>& goals,
                                        config::Problems& problems) {
  std::vector<SweepGoal> sweep_goals;
  if (!section) return sweep_goals;
  const config::MapReader all{*section, "sweep_goals", problems};  // notes what is no map
  for (const auto& entry : section->entries()) {
    config::MapReader map{entry.value, fmt::format("sweep goal '{}'", entry.key), sweep_goal_keys(),
                          problems};
    std::size_t count = 0;
    bool has_share = false;
    for (const SweepGoal::Statistic statistic : kStatistics) {
      const config::Node* node = map.node(to_string(statistic));
      if (!node) continue;
      ++count;
      has_share |= statistic == SweepGoal::Statistic::share;
      SweepGoal goal{.metric = entry.key, .statistic = statistic, .origin = entry.key_origin};
      read_bounds(*node, goal, problems);
      sweep_goals.push_back(std::move(goal));
    }
    const double share_of = read_share_of(map, entry.key, goals, has_share);
    if (has_share) sweep_goals.back().share_of = share_of;  // the last of the statistics
    if (count == 0) problems.add(entry.key_origin, fmt::format("'{}' asks for nothing", entry.key));
    map.finish();
  }
  return sweep_goals;
}

void check_goals(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems) {
  for (const Goal& goal : deployment.goals) {
    check_metric(goal.metric, goal.origin, deployment, plugins, problems);
    for (const ComponentConfig& component : deployment.components) {
      const MetricSpec* metric = find_metric(*component.manifest, goal.metric);
      if (!metric || goal.limit >= 0 || metric->may_be_negative) continue;
      problems.add(goal.limit_origin,
                   fmt::format("the goal {:g} cannot be met: '{}' is never below 0", goal.limit,
                               goal.metric));
    }
  }
  for (const SweepGoal& goal : deployment.sweep_goals) {
    check_metric(goal.metric, goal.origin, deployment, plugins, problems);
    for (const ComponentConfig& component : deployment.components) {
      const MetricSpec* metric = find_metric(*component.manifest, goal.metric);
      if (!metric || goal.at_most.value_or(0) >= 0 || metric->may_be_negative) continue;
      problems.add(goal.origin,
                   fmt::format("the sweep goal {:g} cannot be met: '{}' is never below 0",
                               *goal.at_most, goal.metric));
    }
  }
}

}  // namespace armature
