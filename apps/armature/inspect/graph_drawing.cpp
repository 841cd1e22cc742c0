// SPDX-License-Identifier: Apache-2.0
#include "inspect/graph_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <ranges>
#include <set>

#include "armature/values/json_text.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

using DrawnComponent = DrawnGraph::Component;
using Reader = DrawnGraph::Reader;
using DrawnTopic = DrawnGraph::Topic;

std::vector<std::string> names_of(const std::vector<Reader>& readers) {
  std::vector<std::string> names;
  for (const Reader& reader : readers) names.push_back(reader.component);
  return names;
}

std::string text_of(const DrawnGraph& graph) {
  const auto list = [](const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) {
      text += (text.empty() ? "" : ", ") + terminal_text(name);
    }
    return text.empty() ? std::string{"-"} : text;
  };
  std::size_t width = 0;
  for (const auto& [name, topic] : graph.topics) width = std::max(width, name.size());
  std::string text;
  for (const auto& [name, topic] : graph.topics) {
    text +=
        fmt::format("{:<{}}  {:<32} {} -> {}\n", terminal_text(name), width,
                    terminal_text(topic.type), list(topic.writers), list(names_of(topic.readers)));
  }
  return text;
}

std::string json_of(const DrawnGraph& graph) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, topic] : graph.topics) {
    json[name] = {
        {"type", topic.type}, {"writers", topic.writers}, {"readers", names_of(topic.readers)}};
  }
  return json_text(json) + "\n";
}

/// Writes the components of each process between `open(process)` and `close`; without them when
/// there is one process only.
std::string framed(const DrawnGraph& graph,
                   const std::function<std::string(const DrawnComponent&)>& node,
                   const std::function<std::string(const std::string&)>& open,
                   const std::string& close) {
  std::set<std::string> processes;
  for (const DrawnComponent& component : graph.components) processes.insert(component.process);
  std::string text;
  for (const std::string& process : processes) {
    const bool framed = processes.size() > 1;
    if (framed) text += open(process);
    for (const DrawnComponent& component : graph.components) {
      if (component.process == process) text += (framed ? "  " : "") + node(component);
    }
    if (framed) text += close;
  }
  return text;
}

/// One line for every arrow from a writer to a reader of a topic.
std::string arrows(const DrawnGraph& graph,
                   const std::function<std::string(const std::string& writer, const Reader& reader,
                                                   const std::string& topic)>& arrow) {
  std::string text;
  for (const auto& [name, topic] : graph.topics) {
    for (const auto& writer : topic.writers) {
      for (const Reader& reader : topic.readers) text += arrow(writer, reader, name);
    }
  }
  return text;
}

std::string dot_of(const DrawnGraph& graph) {
  const auto node = [](const DrawnComponent& component) {
    return fmt::format("  \"{0}\" [label=\"{0}\\n{1}\"];\n", component.name, component.plugin);
  };
  const auto open = [](const std::string& process) {
    return fmt::format("  subgraph \"cluster_{0}\" {{\n    label=\"process {0}\";\n", process);
  };
  return fmt::format("digraph \"{}\" {{\n  rankdir=LR;\n  node [shape=box];\n", graph.deployment) +
         framed(graph, node, open, "  }\n") +
         arrows(graph,
                [](const auto& writer, const Reader& reader, const auto& topic) {
                  return fmt::format("  \"{}\" -> \"{}\" [label=\"{}\"{}];\n", writer,
                                     reader.component, topic,
                                     reader.feedback ? ", style=dashed" : "");
                }) +
         "}\n";
}

/// Mermaid's name of a component: "c_motion_planner".
std::string mermaid_name(std::string component) {
  std::ranges::replace(component, '.', '_');
  return "c_" + component;
}

std::string mermaid_of(const DrawnGraph& graph) {
  const auto node = [](const DrawnComponent& component) {
    return fmt::format("  {}[\"{}<br>{}\"]\n", mermaid_name(component.name), component.name,
                       component.plugin);
  };
  const auto open = [](const std::string& process) {
    return fmt::format("  subgraph p_{0}[\"process {0}\"]\n", process);
  };
  return "flowchart LR\n" + framed(graph, node, open, "  end\n") +
         arrows(graph, [](const auto& writer, const Reader& reader, const auto& topic) {
           return fmt::format("  {} {}|\"{}\"| {}\n", mermaid_name(writer),
                              reader.feedback ? "-.->" : "-->", topic,
                              mermaid_name(reader.component));
         });
}

}  // namespace

std::string drawing_of(const DrawnGraph& graph, GraphFormat format) {
  switch (format) {
    case GraphFormat::json: return json_of(graph);
    case GraphFormat::dot: return dot_of(graph);
    case GraphFormat::mermaid: return mermaid_of(graph);
    case GraphFormat::text: break;
  }
  return text_of(graph);
}

}  // namespace armature
