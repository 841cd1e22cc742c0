// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace armature {

/// Who writes and who reads every topic of a deployment.
struct DrawnGraph {
  struct Component {
    std::string name, plugin, process;
  };
  struct Reader {
    std::string component;
    bool feedback = false;  // against the flow, read a cycle late
  };
  struct Topic {
    std::string type;
    std::vector<std::string> writers;
    std::vector<Reader> readers;
  };
  std::string deployment;
  std::vector<Component> components;
  std::map<std::string, Topic> topics;  // by name
};

enum class GraphFormat { text, json, dot, mermaid };

/// Draws the graph: as a table, as JSON, for Graphviz or for Mermaid. The last two have a frame for
/// each process, where there are several, and dashed arrows for feedback.
std::string drawing_of(const DrawnGraph& graph, GraphFormat format);

}  // namespace armature
