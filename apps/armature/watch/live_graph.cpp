// SPDX-License-Identifier: Apache-2.0
#include "watch/live_graph.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <thread>
#include <vector>

#include "exit_code.hpp"
#include "watch/seen_deployments.hpp"

namespace armature {
namespace {

/// What the runtime adds to every process is left out, as in the graph of a file.
bool is_of_runtime(const msg::ComponentDescription& component) {
  return component.plugin_().starts_with("runtime/");
}

DrawnGraph graph_of(const std::string& name, const SeenDeployment& deployment) {
  DrawnGraph graph{.deployment = name};
  for (const std::string& process : deployment.processes.begin()->second.processes_()) {
    for (const auto& component : deployment.processes.at(process).components_()) {
      if (is_of_runtime(component)) continue;
      graph.components.push_back({component.name_(), component.plugin_(), process});
      for (const msg::PortDescription& port : component.ports_()) {
        DrawnGraph::Topic& topic = graph.topics[port.topic_()];
        topic.type = port.type_();
        if (port.output_()) {
          topic.writers.push_back(component.name_());
        } else {
          topic.readers.push_back({component.name_(), port.feedback_()});
        }
      }
    }
  }
  return graph;
}

std::string missing_processes(const std::string& name, const SeenDeployment& deployment) {
  std::vector<std::string> missing;
  if (deployment.processes.empty()) return fmt::format("deployment '{}' has told nothing", name);
  for (const std::string& process : deployment.processes.begin()->second.processes_()) {
    if (!deployment.processes.contains(process)) missing.push_back(process);
  }
  return fmt::format("deployment '{}' is not whole; nothing was heard of process {}", name,
                     fmt::join(missing, ", "));
}

int timed_out(const WatchOptions& options, const std::string& wrong) {
  fmt::print(stderr, "armature: {} within {:g} s\n", wrong, options.timeout_s);
  return kTimedOut;
}

}  // namespace

int draw_live_graph(const WatchOptions& options, const std::string& name, GraphFormat format) {
  leave_in_order();
  SeenDeployments seen{options, name};
  const Time start = monotonic_now();
  std::map<std::string, SeenDeployment> all;
  std::string wrong;
  for (bool told = false; !left();) {
    seen.look();
    all = seen.all();
    const Duration waited = monotonic_now() - start;
    wrong = all.empty() ? fmt::format("no deployment {}tells of itself in domain {}",
                                      name.empty() ? "" : "'" + name + "' ", options.network.domain)
                        : "";
    for (const auto& [deployment, parts] : all) {
      if (!parts.is_whole()) wrong = missing_processes(deployment, parts);
    }
    // Others may be there, which are found at about the same time.
    if (wrong.empty() && (!name.empty() || waited > kDiscovery)) break;
    if (options.timeout_s > 0 && waited > seconds(options.timeout_s) && !wrong.empty()) {
      return timed_out(options, wrong);
    }
    if (!told && !wrong.empty() && options.timeout_s <= 0 && waited > 2 * kDiscovery) {
      told = true;
      fmt::print(stderr, "armature: {} yet, waiting for it\n", wrong);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  if (left()) return kOk;
  if (all.size() > 1) {
    std::vector<std::string> names;
    for (const auto& [deployment, parts] : all) names.push_back(deployment);
    throw InvalidChoice(fmt::format("domain {} has several deployments; name one: {}",
                                    options.network.domain, fmt::join(names, ", ")));
  }
  fmt::print("{}", drawing_of(graph_of(all.begin()->first, all.begin()->second), format));
  return kOk;
}

}  // namespace armature
