// SPDX-License-Identifier: Apache-2.0
#include "armature/config/tree_builder.hpp"

#include <fmt/format.h>

#include <utility>

namespace armature::config {
namespace {

constexpr std::size_t kDeepest = 100;

}  // namespace

bool TreeBuilder::expects_key() const {
  return !levels_.empty() && levels_.back().is_map && !levels_.back().pending;
}

std::optional<Origin> TreeBuilder::pending_key() const {
  if (levels_.empty() || !levels_.back().pending) return std::nullopt;
  return levels_.back().pending->key_origin;
}

void TreeBuilder::add(Node node) {
  if (levels_.empty()) {
    root_ = std::move(node);
    return;
  }
  Level& level = levels_.back();
  if (!level.is_map) {
    level.items.push_back(std::move(node));
  } else if (!level.pending) {
    add_key(level, node);
  } else {
    level.pending->value = std::move(node);
    if (!level.pending_is_duplicate) level.entries.push_back(std::move(*level.pending));
    level.pending.reset();
  }
}

void TreeBuilder::add_key(Level& level, const Node& key) {
  if (key.kind() != Node::Kind::scalar) {
    problems_.add(key.origin(), fmt::format("a key must be a text, not {}", key.describe()));
    level.pending = Node::Entry{"", key.origin(), Node::null(key.origin())};
    return;
  }
  if (key.text() == "<<" && !key.quoted()) {
    problems_.add(key.origin(),
                  "'<<' merges are not read; use 'include:' at the top of the file for shared "
                  "values");
  }
  const auto [first, is_new] = level.keys.emplace(key.text(), key.origin());
  if (!is_new) {
    problems_.add(key.origin(), fmt::format("{} is given twice; first at {}", in_quotes(key.text()),
                                            first->second.text()));
  }
  level.pending = Node::Entry{key.text(), key.origin(), Node::null(key.origin())};
  level.pending_is_duplicate = !is_new;
}

void TreeBuilder::open(bool is_map, const Origin& origin) {
  if (levels_.size() >= kDeepest) {
    problems_.add(origin, fmt::format("nested deeper than {} levels", kDeepest));
    throw ParsingStopped{};
  }
  levels_.push_back({is_map, origin, {}, {}, {}, std::nullopt, false});
}

void TreeBuilder::open_sequence(const Origin& origin) { open(false, origin); }

void TreeBuilder::open_map(const Origin& origin) { open(true, origin); }

void TreeBuilder::close() {
  Level level = std::move(levels_.back());
  levels_.pop_back();
  add(level.is_map ? Node::map(std::move(level.entries), std::move(level.origin))
                   : Node::sequence(std::move(level.items), std::move(level.origin)));
}

}  // namespace armature::config
