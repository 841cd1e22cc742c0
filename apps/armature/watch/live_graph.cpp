// SPDX-License-Identifier: Apache-2.0
#include "watch/live_graph.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "terminal_text.hpp"
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
    if (!deployment.processes.contains(process)) continue;
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

/// "deployment 'lamp': nothing was heard of process 'vision'"; empty: all is known.
std::string incomplete(const std::map<std::string, SeenDeployment>& all) {
  for (const auto& [name, deployment] : all) {
    if (deployment.processes.empty()) {
      return fmt::format("deployment '{}' has not told what it consists of", terminal_text(name));
    }
    if (!deployment.is_whole()) {
      return terminal_text(fmt::format("deployment '{}': nothing was heard of process '{}'", name,
                                       fmt::join(deployment.missing(), "', '")));
    }
  }
  return "";
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
  const Duration patience = options.timeout_s > 0 ? seconds(options.timeout_s) : 2 * kDiscovery;
  std::map<std::string, SeenDeployment> all;
  for (bool told = false; wait_for(seconds(0.05));) {
    seen.look();
    all = seen.all();
    const Duration waited = monotonic_now() - start;
    const bool is_told =
        std::ranges::any_of(all, [](const auto& one) { return !one.second.processes.empty(); });
    // Others may be there, which are found at about the same time.
    const bool all_found = !name.empty() || waited > kDiscovery;
    if (is_told && incomplete(all).empty() && all_found) break;
    if (waited < patience) continue;
    if (is_told) break;  // one of its processes may have died
    const std::string none =
        fmt::format("no deployment {}tells of itself in domain {}",
                    name.empty() ? "" : "'" + name + "' ", options.network.domain);
    if (options.timeout_s > 0) return timed_out(options, none);
    if (!std::exchange(told, true)) {
      fmt::print(stderr, "armature: {} yet, waiting for it\n", none);
    }
  }
  if (left()) return kOk;
  for (const std::string& note : seen.notes()) {
    fmt::print(stderr, "armature: {}\n", terminal_text(note));
  }
  std::erase_if(all, [](const auto& one) { return one.second.processes.empty(); });
  if (const std::string missing = incomplete(all); !missing.empty()) {
    fmt::print(stderr, "armature: {}\n", missing);
  }
  if (all.size() > 1) {
    std::vector<std::string> names;
    for (const auto& [deployment, parts] : all) names.push_back(deployment);
    throw InvalidChoice(fmt::format("domain {} has several deployments; name one: {}",
                                    options.network.domain, fmt::join(names, ", ")));
  }
  std::string drawing = drawing_of(graph_of(all.begin()->first, all.begin()->second), format);
  if (drawing.empty()) return kOk;  // it has no topics
  drawing.pop_back();
  tell(drawing);
  return kOk;
}

}  // namespace armature
