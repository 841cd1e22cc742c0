// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/graph.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"

namespace armature {
namespace {

struct Writer {
  std::size_t component;
  const PortBinding* port;
};
using Writers = std::map<std::string, std::vector<Writer>>;

std::string port_name(const ComponentConfig& component, const PortBinding& port) {
  return fmt::format("{}.{}", component.name, port.spec.name);
}

/// A topic has one writer, or several that all share it and write alike; else why not.
std::optional<std::string> refusal(const PortBinding& first, const PortBinding& second) {
  if (!first.spec.shared || !second.spec.shared) return "";
  if (first.spec.type == second.spec.type) return std::nullopt;
  return fmt::format(", as '{}' and as '{}'", first.spec.type, second.spec.type);
}

/// Of topics that are written wrongly, the first writer: what follows from the second is no news.
Writers find_writers(const DeploymentConfig& deployment, config::Problems& problems) {
  Writers writers;
  for (std::size_t i = 0; i < deployment.components.size(); ++i) {
    const ComponentConfig& component = deployment.components[i];
    for (const PortBinding& port : component.outputs) {
      std::vector<Writer>& there = writers[port.topic];
      const auto refused = there.empty() ? std::nullopt : refusal(*there.front().port, port);
      if (!refused) {
        there.push_back({i, &port});
        continue;
      }
      const Writer& first = there.front();
      problems.add(
          port.origin,
          fmt::format(
              "{} and {} both write topic '{}'{}; give one of them others with 'topics:' or 'out:'",
              port_name(deployment.components[first.component], *first.port),
              port_name(component, port), port.topic, *refused));
    }
  }
  return writers;
}

/// The entry of `robots:` that the component is bound to, for "robot"; nullptr: none.
const std::string* bound(const ComponentConfig& component, const std::string& word) {
  const auto section = std::ranges::find(kDocumentSections, std::string_view{word},
                                         [](const auto& one) { return one.second; });
  if (section == kDocumentSections.end()) return nullptr;
  const auto there = component.documents.find(std::string{section->first});
  return there == component.documents.end() ? nullptr : &there->second;
}

/// Does `input` understand what `output` writes?
void check_match(const ComponentConfig& reader, const PortBinding& input,
                 const ComponentConfig& writer, const PortBinding& output,
                 config::Problems& problems) {
  const auto mismatch = [&](std::string_view what, std::string_view wanted, std::string_view got) {
    problems.add(input.origin,
                 fmt::format("{} reads {} '{}' from topic '{}', but {} writes {} '{}'",
                             port_name(reader, input), what, wanted, input.topic,
                             port_name(writer, output), what, got));
  };
  if (input.spec.type != output.spec.type) {
    mismatch("type", input.spec.type, output.spec.type);
  }
  if (!input.spec.frame.empty() && !output.spec.frame.empty() &&
      input.spec.frame != output.spec.frame) {
    mismatch("poses in frame", input.spec.frame, output.spec.frame);
  }
  const std::string *read_of = bound(reader, input.spec.of),
                    *written_of = bound(writer, output.spec.of);
  if (input.spec.of == output.spec.of && read_of && written_of && *read_of != *written_of) {
    mismatch("values of " + input.spec.of, *read_of, *written_of);
  }
  // No other profile says when a command is too old.
  if ((settings(input.spec.qos).transient_local && !settings(output.spec.qos).transient_local) ||
      (input.spec.qos == QosProfile::command && output.spec.qos != QosProfile::command)) {
    mismatch("QoS", to_string(input.spec.qos), to_string(output.spec.qos));
  }
}

std::vector<std::string> words_of(const std::string& topic) {
  std::vector<std::string> words;
  std::istringstream text{topic};
  for (std::string word; std::getline(text, word, '/');) words.push_back(word);
  return words;
}

/// Whether one word of `there` is `asked` misspelt, and all others are the same.
bool is_misspelt(const std::string& asked, const std::string& there) {
  const auto wanted = words_of(asked), written = words_of(there);
  if (wanted.size() != written.size()) return false;
  int wrong = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == written[i]) continue;
    wrong += config::spelling_hint(wanted[i], {&written[i], 1}).empty() ? 2 : 1;
  }
  return wrong == 1;
}

/// The topic of that type that may have been meant: one word misspelt, the same one of another arm,
/// or the nearest in spelling.
std::string meant(const std::string& topic, const std::vector<std::string>& written,
                  const std::string& deployment) {
  for (const std::string& there : written) {
    if (is_misspelt(topic, there)) return fmt::format("; did you mean '{}'?", there);
  }
  const auto under_deployment = [&](const std::string& name) {
    const std::string space = '/' + deployment;
    return name.starts_with(space + '/') ? name.substr(space.size()) : name;
  };
  const std::string asked = under_deployment(topic);
  for (const std::string& there : written) {
    const std::string name = under_deployment(there);
    if (name.ends_with(asked) || asked.ends_with(name)) {
      return fmt::format("; did you mean '{}'?", there);
    }
  }
  return config::did_you_mean(topic, written);
}

/// "; add a component that does: arm/simulated" where none of the plugins that write such a topic
/// is in the deployment; else "".
std::string missing(const PortBinding& input, const DeploymentConfig& deployment,
                    const PluginRegistry& plugins) {
  std::vector<std::string> ids;
  for (const PluginManifest& plugin : plugins.plugins()) {
    const bool is_component = plugin.kind == Component::kKind;
    const PluginManifest* manifest = is_component ? &plugin : plugins.host_of(plugin.kind);
    const bool writes = manifest && plugin.hosts.empty() &&
                        std::ranges::any_of(manifest->outputs, [&](const PortSpec& output) {
                          return output.topic == input.spec.topic && output.type == input.spec.type;
                        });
    if (writes) ids.push_back(plugin.id);
  }
  const bool is_there = std::ranges::any_of(deployment.components, [&](const auto& component) {
    return std::ranges::find(ids, component.plugin_id) != ids.end();
  });
  if (ids.empty() || is_there) return "";
  return fmt::format("; add a component that does: {}", fmt::join(ids, ", "));
}

void check_inputs(const DeploymentConfig& deployment, const Writers& writers,
                  const PluginRegistry& plugins, config::Problems& problems) {
  const auto topics_of = [&](const std::string& type) {
    std::vector<std::string> topics;
    for (const auto& [topic, there] : writers) {
      if (there.front().port->spec.type == type) topics.push_back(topic);
    }
    return topics;
  };
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& input : component.inputs) {
      const auto there = writers.find(input.topic);
      if (there != writers.end()) {
        for (const Writer& writer : there->second) {
          check_match(component, input, deployment.components[writer.component], *writer.port,
                      problems);
        }
      } else if (!input.spec.outside && (!input.spec.optional || input.renamed)) {
        std::string hint = input.renamed ? "" : missing(input, deployment, plugins);
        if (hint.empty()) {
          hint = meant(input.topic, topics_of(input.spec.type), deployment.name);
        }
        problems.add(input.origin, fmt::format("{} reads topic '{}', which nobody writes{}",
                                               port_name(component, input), input.topic, hint));
      }
    }
  }
}

/// Places the components so that every writer comes before its readers, feedback aside.
void place_components(DeploymentConfig& deployment, const Writers& writers,
                      config::Problems& problems) {
  const std::size_t count = deployment.components.size();
  std::vector<std::set<std::size_t>> sources(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const PortBinding& input : deployment.components[i].inputs) {
      const auto there = writers.find(input.topic);
      if (there == writers.end() || input.spec.feedback) continue;
      for (const Writer& writer : there->second) sources[i].insert(writer.component);
    }
  }
  std::set<std::size_t> placed;
  for (int place = 0; placed.size() < count; ++place) {
    std::size_t next = 0;
    while (next < count &&
           (placed.contains(next) || !std::includes(placed.begin(), placed.end(),
                                                    sources[next].begin(), sources[next].end()))) {
      ++next;
    }
    if (next == count) {
      std::vector<std::string> cycle;
      const ComponentConfig* first = nullptr;
      for (std::size_t i = 0; i < count; ++i) {
        if (placed.contains(i)) continue;
        if (!first) first = &deployment.components[i];
        cycle.push_back(deployment.components[i].name);
      }
      problems.add(first->origin,
                   fmt::format("a cycle without a declared delay among {}: one input in it must be "
                               "'feedback: true' in its plugin.yaml",
                               fmt::join(cycle, ", ")));
      return;
    }
    deployment.components[next].place = place;
    placed.insert(next);
  }
}

}  // namespace

void check_graph(DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems) {
  const Writers writers = find_writers(deployment, problems);
  check_inputs(deployment, writers, plugins, problems);
  place_components(deployment, writers, problems);
}

const PortBinding* find_port(const std::vector<PortBinding>& ports, std::string_view name) {
  const auto is_it = [&](const PortBinding& port) { return port.spec.name == name; };
  const auto found = std::ranges::find_if(ports, is_it);
  return found == ports.end() ? nullptr : &*found;
}

bool has_topic(const std::vector<PortBinding>& ports, std::string_view topic) {
  return std::ranges::find(ports, topic, &PortBinding::topic) != ports.end();
}

const ComponentConfig* writer_of(std::string_view topic, const DeploymentConfig& deployment) {
  const auto& all = deployment.components;
  const auto writes = [&](const ComponentConfig& one) { return has_topic(one.outputs, topic); };
  const auto writer = std::ranges::find_if(all, writes);
  return writer == all.end() ? nullptr : &*writer;
}

bool reads_from(const ComponentConfig& reader, const ComponentConfig& writer) {
  return std::ranges::any_of(writer.outputs, [&](const PortBinding& output) {
    return has_topic(reader.inputs, output.topic);
  });
}

bool exchange_topics(const ComponentConfig& a, const ComponentConfig& b) {
  return reads_from(a, b) || reads_from(b, a);
}

}  // namespace armature
