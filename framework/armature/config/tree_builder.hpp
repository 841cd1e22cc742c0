// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature::config {

/// The document cannot be read further; the reason is among the problems.
struct ParsingStopped {};

/// Puts the nodes of one document together from the events of a parser, and checks what a parser
/// does not: keys are texts, given once, no `<<`, nesting up to 100 levels.
class TreeBuilder {
 public:
  explicit TreeBuilder(Problems& problems) : problems_{problems} {}

  /// A scalar, a null, or an item, value or key of the innermost list or map.
  void add(Node node);
  void open_sequence(const Origin& origin);
  void open_map(const Origin& origin);
  /// Ends the innermost list or map.
  void close();

  bool expects_key() const;
  /// The place of the key whose value comes next; none in a list or at the root.
  std::optional<Origin> pending_key() const;
  const std::optional<Node>& root() const { return root_; }

 private:
  struct Level {
    bool is_map;
    Origin origin;
    std::vector<Node> items;
    std::vector<Node::Entry> entries;
    std::map<std::string, Origin, std::less<>> keys;
    std::optional<Node::Entry> pending;  // a key that waits for its value
    bool pending_is_duplicate = false;
  };

  void open(bool is_map, const Origin& origin);
  void add_key(Level& level, const Node& key);

  Problems& problems_;
  std::vector<Level> levels_;
  std::optional<Node> root_;
};

}  // namespace armature::config
