// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/deployment_config.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/capabilities.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/component_units.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "armature/runtime/deployment_file/fingerprint.hpp"
#include "armature/runtime/deployment_file/goals.hpp"
#include "armature/runtime/deployment_file/graph.hpp"
#include "armature/runtime/deployment_file/linked_parameters.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/deployment_file/open_inputs.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;

bool is_name(std::string_view text) {
  const bool digit = !text.empty() && std::isdigit(static_cast<unsigned char>(text.front()));
  return !text.empty() && !digit && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_';
  });
}

/// The entries of a section that must be a map; none when it is missing or wrong.
std::span<const Node::Entry> entries_of(const Node* section, std::string_view name,
                                        Problems& problems) {
  if (!section) return {};
  if (section->kind() != Node::Kind::map) {
    problems.add(section->origin(),
                 fmt::format("'{}' must be a map, not {}", name, section->describe()));
  }
  return section->entries();
}

/// `name: file.yaml` entries; the files are relative to the YAML file that names them.
std::map<std::string, Node> read_documents(std::span<const Node::Entry> section,
                                           Problems& problems) {
  std::map<std::string, Node> documents;
  for (const auto& [name, name_origin, value] : section) {
    documents.emplace(name, Node::null(value.origin()));  // known, even when it cannot be read
    const auto file = config::as_text(value, problems);
    if (!file) continue;
    const std::filesystem::path path = config::folder_of(value.origin()) / *file;
    try {
      documents.insert_or_assign(name, config::load(path));
    } catch (const config::ConfigError& error) {
      for (const auto& problem : error.problems()) {
        // A file that is not there is a mistake of the line that names it.
        problems.add(problem.origin.line > 0 ? problem.origin : value.origin(), problem.message);
      }
    }
  }
  return documents;
}

int read_cpu(MapReader& map) {
  const std::int64_t cpu = map.integer(keys::kCpu.name, 0);
  const std::int64_t count = sysconf(_SC_NPROCESSORS_CONF);
  if (cpu < 0 || cpu >= count) {
    map.problem(keys::kCpu.name,
                fmt::format("'cpu' is {}, this machine has 0 to {}", cpu, count - 1));
  }
  return static_cast<int>(cpu);
}

std::vector<ExecutorSpec> read_executors(std::span<const Node::Entry> section, Problems& problems) {
  std::vector<ExecutorSpec> executors;
  for (const auto& [name, name_origin, value] : section) {
    MapReader map{value, fmt::format("executor '{}'", name), problems};
    ExecutorSpec spec{.name = name, .period = {}, .priority = 0, .cpu = {}};
    if (map.optional_node(keys::kPeriod.name)) {
      const double period = map.number(keys::kPeriod.name, *keys::kPeriod.min);
      spec.period = seconds(period);
      if (!is_within(keys::kPeriod, period)) {
        map.problem(keys::kPeriod.name,
                    fmt::format("'period_s' is {:g}, must be from {:g} to {:g}", period,
                                *keys::kPeriod.min, *keys::kPeriod.max));
      }
    }
    const std::int64_t priority = map.integer(keys::kPriority.name, 0);
    if (!is_within(keys::kPriority, static_cast<double>(priority))) {
      map.problem(keys::kPriority.name, "'priority' must be from 0 (normal) to 99");
    }
    spec.priority = static_cast<int>(priority);
    if (map.optional_node(keys::kCpu.name)) spec.cpu = read_cpu(map);
    spec.lock_memory = map.flag(keys::kLockMemory.name, false);
    map.finish();
    executors.push_back(std::move(spec));
  }
  const auto is_main = [](const ExecutorSpec& spec) { return spec.name == kMainExecutor; };
  if (std::none_of(executors.begin(), executors.end(), is_main)) {
    executors.push_back(
        {.name = std::string{kMainExecutor}, .period = {}, .priority = 0, .cpu = {}});
  }
  return executors;
}

}  // namespace

std::vector<std::string> DeploymentConfig::processes() const {
  std::set<std::string> others;
  for (const auto& component : components) {
    if (component.process != kMainProcess) others.insert(component.process);
  }
  std::vector<std::string> all{std::string{kMainProcess}};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

bool check_is_deployment(const Node& root, Problems& problems) {
  if (root.find(keys::kArmature.name)) return true;
  const std::array<std::pair<std::string_view, std::string_view>, 3> others{
      {{"armature_robot", "a robot file, which a deployment names under 'robots:'"},
       {"armature_rig", "a rig of cameras, which a deployment names under 'rigs:'"},
       {"armature_plugin", "what a plugin says of itself"}}};
  std::string what;
  for (const auto& [key, is] : others) {
    if (root.find(key)) what = fmt::format(" but {}", is);
  }
  problems.add(root.origin(),
               fmt::format("not a deployment{}: it must begin with 'armature: 1'", what));
  return false;
}

DeploymentConfig read_deployment(const Node& root, const PluginRegistry& plugins,
                                 Problems& problems) {
  DeploymentConfig deployment;
  MapReader map{root, "the deployment", problems};
  if (!check_is_deployment(root, problems)) return deployment;
  if (!is_within(keys::kArmature, static_cast<double>(map.integer(keys::kArmature.name, 1)))) {
    map.problem(keys::kArmature.name, "'armature' is the version of the file format and must be 1");
  }
  deployment.name = map.text(keys::kName.name);
  if (!deployment.name.empty() && !is_name(deployment.name)) {
    map.problem(keys::kName.name,
                fmt::format("'{}' must consist of letters, digits and '_', and begin "
                            "with no digit: it is the namespace of the topics",
                            deployment.name));
  }
  deployment.simulated =
      map.choice(keys::kClock.name, choices_of(keys::kClock), "system") == "simulated";
  const std::int64_t domain = map.integer(keys::kDomain.name, 0);
  if (!is_within(keys::kDomain, static_cast<double>(domain))) {
    map.problem(keys::kDomain.name, "'domain' must be from 0 to 232");
  }
  deployment.domain = static_cast<int>(domain);
  deployment.dds = read_dds(map.optional_node(keys::kDds.name), problems);
  deployment.seed = map.natural(keys::kSeed.name, 1);
  deployment.time_limit_s = 0;
  if (const Node* run = map.optional_node(keys::kRun.name)) {
    MapReader run_map{*run, "run", problems};
    deployment.time_limit_s = run_map.number(keys::kTimeLimit.name, 0.0);
    if (!is_within(keys::kTimeLimit, deployment.time_limit_s)) {
      run_map.problem(keys::kTimeLimit.name, "'time_limit_s' must be positive, or 0 for none");
    }
    deployment.stop_within_s = run_map.number(keys::kStopWithin.name, deployment.stop_within_s);
    if (!is_within(keys::kStopWithin, deployment.stop_within_s)) {
      run_map.problem(
          keys::kStopWithin.name,
          fmt::format("'stop_within_s' is {:g}, must be from {:g} to {:g}: what moves "
                      "comes to rest before anything ends",
                      deployment.stop_within_s, *keys::kStopWithin.min, *keys::kStopWithin.max));
    }
    run_map.finish();
  }
  deployment.executors = read_executors(
      entries_of(map.optional_node(keys::kExecutors.name), keys::kExecutors.name, problems),
      problems);
  for (const auto& [section, word] : kDocumentSections) {
    deployment.documents[std::string{section}] =
        read_documents(entries_of(map.optional_node(section), section, problems), problems);
  }
  deployment.goals = read_goals(map.optional_node(keys::kGoals.name), problems);
  const Node* open = map.optional_node(keys::kOpen.name);
  if (const Node* components = map.node(keys::kComponents.name)) {
    const ComponentReader reader{deployment, plugins, problems};
    std::size_t known = 0;
    for (const auto& entry : entries_of(components, keys::kComponents.name, problems)) {
      if (const auto component = reader.read(entry)) {
        check_slot_needs(*component, plugins, problems);
        std::ranges::move(units_of(*component), std::back_inserter(deployment.components));
        ++known;
      }
    }
    add_unit_executors(deployment);
    // With a component missing, whoever waits for it would look wrong too.
    if (known == components->entries().size()) {
      open_inputs(open, deployment, problems);
      check_graph(deployment, plugins, problems);
      check_isolation(deployment, problems);
      decide_on_faults(deployment);
      check_component_needs(deployment, plugins, problems);
      link_parameters(deployment, problems);
      check_goals(deployment, plugins, problems);
    }
  }
  map.finish();
  deployment.fingerprint = fingerprint_of(root, deployment);
  return deployment;
}

}  // namespace armature
