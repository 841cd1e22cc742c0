// SPDX-License-Identifier: Apache-2.0
#include "armature/config/node.hpp"

#include <fmt/format.h>

#include <utility>

#include "armature/config/problems.hpp"

namespace armature::config {

std::string Origin::text() const {
  return line == 0 ? file : fmt::format("{}:{}:{}", file, line, column);
}

Node Node::null(Origin origin) {
  Node node;
  node.origin_ = std::move(origin);
  return node;
}

Node Node::scalar(std::string text, bool quoted, Origin origin) {
  Node node = null(std::move(origin));
  node.kind_ = Kind::scalar;
  node.text_ = std::move(text);
  node.quoted_ = quoted;
  return node;
}

Node Node::sequence(std::vector<Node> items, Origin origin) {
  Node node = null(std::move(origin));
  node.kind_ = Kind::sequence;
  node.items_ = std::move(items);
  return node;
}

Node Node::map(std::vector<Entry> entries, Origin origin) {
  Node node = null(std::move(origin));
  node.kind_ = Kind::map;
  node.entries_ = std::move(entries);
  return node;
}

std::string Node::describe() const {
  switch (kind_) {
    case Kind::null: return "nothing";
    case Kind::scalar: return in_quotes(text_);
    case Kind::sequence: return "a list";
    case Kind::map: return "a map";
  }
  return "";
}

std::span<const Node> Node::items() const { return items_; }

std::span<const Node::Entry> Node::entries() const { return entries_; }

const Node* Node::find(std::string_view key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

}  // namespace armature::config
