// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/deployment_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/capabilities.hpp"
#include "armature/runtime/deployment_file/completed_file.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/component_units.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "armature/runtime/deployment_file/fingerprint.hpp"
#include "armature/runtime/deployment_file/goals.hpp"
#include "armature/runtime/deployment_file/graph.hpp"
#include "armature/runtime/deployment_file/linked_parameters.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;

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

/// The file that an entry names, or none and a problem.
std::optional<Node> load_document(const Node& named, Problems& problems) {
  const auto file = config::as_text(named, problems);
  if (!file) return std::nullopt;
  try {
    return config::load(config::folder_of(named.origin()) / *file);
  } catch (const config::ConfigError& error) {
    for (const auto& problem : error.problems()) {
      // A file that is not there is a mistake of the line that names it.
      problems.add(problem.origin.line > 0 ? problem.origin : named.origin(), problem.message);
    }
    return std::nullopt;
  }
}

/// `{file: robot.yaml, home_deg: [..]}`: the file, with another home, which whoever reads the robot
/// refuses at the place where it stands.
std::optional<Node> load_robot(const Node::Entry& entry, Problems& problems) {
  MapReader map{entry.value, fmt::format("robot '{}'", entry.key), robot_entry_keys(), problems};
  map.text("file");
  map.optional_numbers("home_deg");
  map.finish();
  const Node* file = entry.value.find("file");
  auto document = file ? load_document(*file, problems) : std::nullopt;
  if (!document || document->kind() != Node::Kind::map) return document;
  const std::string home = map.written("home_deg");
  const auto& written = entry.value.entries();
  const auto given = std::ranges::find(written, home, &Node::Entry::key);
  if (given == written.end()) return document;
  auto& entries = document->mutable_entries();
  std::erase_if(entries, [](const Node::Entry& of_file) {
    return of_file.key == "home_deg" || of_file.key == "home";
  });
  entries.push_back(*given);
  return document;
}

/// `name: file.yaml` entries; the files are relative to the YAML file that names them.
std::map<std::string, Node> read_documents(std::string_view name,
                                           std::span<const Node::Entry> section,
                                           const RecordedDocuments* recorded, Problems& problems) {
  std::map<std::string, Node> documents;
  for (const Node::Entry& entry : section) {
    if (recorded && entry.value.origin().line > 0) {
      const std::string file = fmt::format("{}/{}", name, entry.key);
      const auto known = recorded->find(file);
      if (known == recorded->end()) {
        problems.add(entry.key_origin, fmt::format("the recording has no '{}'", file));
      }
      documents.emplace(
          entry.key, known == recorded->end() ? Node::null(entry.value.origin()) : known->second);
      continue;
    }
    const bool is_map = name == kRobotsSection && entry.value.kind() == Node::Kind::map;
    auto document = is_map ? load_robot(entry, problems) : load_document(entry.value, problems);
    // Known, even when it cannot be read.
    documents.emplace(entry.key,
                      document ? std::move(*document) : Node::null(entry.value.origin()));
  }
  return documents;
}

std::vector<ExecutorSpec> read_executors(std::span<const Node::Entry> section,
                                         const DeploymentConfig& deployment, Problems& problems) {
  std::vector<ExecutorSpec> executors;
  for (const auto& [name, name_origin, value] : section) {
    MapReader map{value, fmt::format("executor '{}'", name), executor_keys(), problems};
    ExecutorSpec spec{.name = name, .period = {}, .priority = 0};
    if (const auto period = map.optional_number("period_s")) spec.period = seconds(*period);
    spec.priority = static_cast<int>(map.integer("priority"));
    if (const auto cpu = map.optional_integer("cpu")) spec.cpu = static_cast<int>(*cpu);
    spec.lock_memory = map.flag("lock_memory");
    spec.sim_pause = seconds(map.number("sim_pause_s"));
    spec.seed = deployment.seed_of("executor " + name);
    map.finish();
    executors.push_back(std::move(spec));
  }
  const auto is_main = [](const ExecutorSpec& spec) { return spec.name == kMainExecutor; };
  if (std::none_of(executors.begin(), executors.end(), is_main)) {
    executors.push_back({.name = std::string{kMainExecutor}, .period = {}, .priority = 0});
  }
  return executors;
}

/// The time limit and how long its end may take.
void read_run(const Node& section, DeploymentConfig& deployment, Problems& problems) {
  MapReader map{section, "run", run_keys(), problems};
  deployment.time_limit_s = map.number("time_limit_s");
  deployment.stop_within_s = map.number("stop_within_s");
  map.finish();
}

/// What the deployment writes itself is its own: `outside: true` of a plugin says then that anybody
/// may give a command (a stop, an operator's word), and of everything else that the deployment need
/// not write it.
void close_written_inputs(DeploymentConfig& deployment) {
  std::set<std::string_view> written;
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& output : component.outputs) written.insert(output.topic);
  }
  for (ComponentConfig& component : deployment.components) {
    for (PortBinding& input : component.inputs) {
      const bool is_command = input.spec.qos == QosProfile::command;
      if (!is_command && written.contains(input.topic)) input.spec.outside = false;
    }
  }
}

/// Opens one of the inputs of `deployment` to programs that are no part of it.
void open_input(const Node& item, DeploymentConfig& deployment, Problems& problems) {
  const auto wanted = config::to_text(item);
  if (!wanted) {
    problems.add(item.origin(),
                 fmt::format("'open' lists inputs as component.port, not {}", item.describe()));
    return;
  }
  std::vector<std::string> names;
  for (ComponentConfig& component : deployment.components) {
    for (PortBinding& input : component.inputs) {
      names.push_back(fmt::format("{}.{}", component.name, input.spec.name));
      if (names.back() != *wanted) continue;
      if (input.spec.qos != QosProfile::command) {
        input.spec.outside = true;
        return;
      }
      problems.add(item.origin(),
                   fmt::format("'{}' takes commands, which come from the deployment itself only; "
                               "open an input of a component that decides, and let that one "
                               "command",
                               *wanted));
      return;
    }
  }
  problems.add(item.origin(), fmt::format("no component has the input '{}'{}", *wanted,
                                          config::did_you_mean(*wanted, names)));
}

/// `open: [task.target]`; null: nothing is opened.
void open_inputs(const Node* list, DeploymentConfig& deployment, Problems& problems) {
  if (!list) return;
  if (list->kind() != Node::Kind::sequence) {
    problems.add(
        list->origin(),
        fmt::format("'open' must be a list of inputs, [task.target], not {}", list->describe()));
    return;
  }
  for (const Node& item : list->items()) open_input(item, deployment, problems);
}

/// What the components name there, each once, the main one first.
std::vector<std::string> names_at(std::string ComponentConfig::*place, std::string_view main_one,
                                  const std::vector<ComponentConfig>& components) {
  std::set<std::string> others;
  for (const ComponentConfig& component : components) others.insert(component.*place);
  others.erase(std::string{main_one});
  std::vector<std::string> all{std::string{main_one}};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

std::vector<std::string> DeploymentConfig::processes() const {
  return names_at(&ComponentConfig::process, kMainProcess, components);
}

std::vector<std::string> DeploymentConfig::hosts() const {
  return names_at(&ComponentConfig::host, kMainHost, components);
}

std::vector<std::string> DeploymentConfig::measuring() const {
  std::vector<std::string> names;
  for (const ComponentConfig& component : components) {
    const auto is_measured = [](const PortBinding& output) { return output.spec.measured; };
    if (std::ranges::any_of(component.outputs, is_measured)) names.push_back(component.name);
  }
  return names;
}

int DeploymentConfig::measuring_index(std::string_view component) const {
  const std::vector<std::string> names = measuring();
  return static_cast<int>(std::ranges::find(names, component) - names.begin());
}

std::string DeploymentConfig::host_of(std::string_view process) const {
  const auto found = std::ranges::find(components, process, &ComponentConfig::process);
  return found == components.end() ? std::string{kMainHost} : found->host;
}

InputFromElsewhere DeploymentConfig::from_elsewhere(const PortBinding& input,
                                                    std::string_view process) const {
  InputFromElsewhere from;
  for (const ComponentConfig& component : components) {
    if (component.process == process) continue;
    for (const PortBinding& output : component.outputs) {
      if (output.topic != input.topic) continue;
      from.outputs.push_back(&output);
      from.processes.insert(component.process);
    }
  }
  from.is_numbered = from.outputs.size() == 1 && !input.spec.outside;
  return from;
}

bool check_is_deployment(const Node& root, Problems& problems) {
  if (root.find("armature")) return true;
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

namespace {

/// A process is on one host, the main one on the main host, and hosts hear each other.
void check_hosts(const DeploymentConfig& deployment, Problems& problems) {
  const ComponentConfig* apart = nullptr;
  for (const ComponentConfig& component : deployment.components) {
    if (component.unit != kMainUnit) continue;
    if (!apart && component.host != kMainHost) apart = &component;
    const bool is_main = component.process == kMainProcess;
    const std::string host =
        is_main ? std::string{kMainHost} : deployment.host_of(component.process);
    if (component.host == host) continue;
    problems.add(component.origin,
                 fmt::format("component '{}' is on host '{}', and its process '{}' on '{}'{}",
                             component.name, component.host, component.process, host,
                             is_main ? ", as always" : ""));
  }
  const auto leads_out = [](const DdsConfig::Named& interface) {
    return interface.name != "lo" && !interface.name.starts_with("127.");
  };
  if (apart && std::ranges::none_of(deployment.dds.interfaces, leads_out)) {
    problems.add(apart->origin,
                 fmt::format("component '{}' is on another host, and no network leads there: name "
                             "the interfaces to join, dds: {{interfaces: [eth0]}}",
                             apart->name));
  }
}

}  // namespace

std::uint64_t DeploymentConfig::seed_of(std::string_view part) const {
  // FNV-1a: the same on every machine.
  std::uint64_t hash = 14695981039346656037ULL ^ seed;
  for (const unsigned char c : part) hash = (hash ^ c) * 1099511628211ULL;
  return hash;
}

DeploymentConfig read_deployment(const Node& root, const PluginRegistry& plugins,
                                 Problems& problems, const RecordedDocuments* recorded) {
  DeploymentConfig deployment;
  MapReader map{root, "the deployment", deployment_keys(), problems};
  if (!check_is_deployment(root, problems)) return deployment;
  map.integer("armature");
  deployment.name = map.text("name");
  const Node* name = root.find("name");
  const bool is_text = name && name->kind() == Node::Kind::scalar;
  if (const auto defect = name_defect(deployment.name); defect && is_text) {
    map.problem("name", *defect + ": it is the namespace of the topics");
    deployment.name.clear();  // its topics are not to be wrong, too
  }
  deployment.simulated = map.text("clock") == "simulated";
  deployment.domain = static_cast<int>(map.integer("domain"));
  deployment.dds = read_dds(map.node("dds"), problems);
  deployment.seed = map.natural("seed");
  if (const Node* run = map.node("run")) read_run(*run, deployment, problems);
  const Node* record = map.node("record");
  if (record) deployment.record = read_record(*record, problems);
  deployment.executors = read_executors(entries_of(map.node("executors"), "executors", problems),
                                        deployment, problems);
  for (const auto& [section, word] : kDocumentSections) {
    deployment.documents[std::string{section}] = read_documents(
        section, entries_of(map.node(section), section, problems), recorded, problems);
  }
  deployment.goals = read_goals(map.node("goals"), problems);
  deployment.sweep_goals = read_sweep_goals(map.node("sweep_goals"), deployment.goals, problems);
  const Node* open = map.node("open");
  if (const Node* components = map.node("components")) {
    const ComponentReader reader{deployment, plugins, problems};
    std::size_t known = 0;
    for (const auto& entry : entries_of(components, "components", problems)) {
      if (const auto component = reader.read(entry)) {
        check_slot_needs(*component, plugins, problems);
        std::ranges::move(units_of(*component), std::back_inserter(deployment.components));
        ++known;
      }
    }
    add_unit_executors(deployment);
    // With a component missing, whoever waits for it would look wrong too.
    if (known == components->entries().size()) {
      close_written_inputs(deployment);
      open_inputs(open, deployment, problems);
      check_graph(deployment, plugins, problems);
      check_isolation(deployment, problems);
      check_hosts(deployment, problems);
      decide_on_faults(deployment);
      check_component_needs(deployment, plugins, problems);
      link_parameters(deployment, problems);
      check_goals(deployment, plugins, problems);
      if (record)
        check_record(*deployment.record, *record, deployment.name, deployment.components, problems);
    }
  }
  map.finish();
  deployment.fingerprint = fingerprint_of(root, deployment);
  if (problems.empty()) deployment.file = completed_file(root, plugins);
  return deployment;
}

}  // namespace armature
