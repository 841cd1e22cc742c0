// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace armature {
namespace config ARMATURE_EXPORT {

/// Where a value was written: `file:line:column`, both counted from 1; a line of 0 means that the
/// place has no lines (`--set components.arm.plugin=...`, a default).
struct Origin {
  std::string file;
  int line = 0;
  int column = 0;

  std::string text() const;
};

/// One node of a YAML document as its author wrote it: a scalar keeps its text, a map its order,
/// and every key and value its place. Nothing is converted here; see `Reader` for that.
class Node {
 public:
  enum class Kind { null, scalar, sequence, map };
  struct Entry;  // key, key's origin, value

  static Node null(Origin origin);
  static Node scalar(std::string text, bool quoted, Origin origin);
  static Node sequence(std::vector<Node> items, Origin origin);
  static Node map(std::vector<Entry> entries, Origin origin);

  Kind kind() const { return kind_; }
  const Origin& origin() const { return origin_; }
  /// "a map", "a list", "nothing" or "'the text'" (one line, cut when long): for messages.
  std::string describe() const;

  /// The text of a scalar; `null` or `~` of a null that was written out; empty otherwise, so a null
  /// without text is a key that was given no value.
  const std::string& text() const { return text_; }
  /// True when the scalar was written in quotes, and so is a string whatever it looks like.
  bool quoted() const { return quoted_; }
  std::span<const Node> items() const;
  std::span<const Entry> entries() const;
  /// The value under `key`, or nullptr.
  const Node* find(std::string_view key) const;

  std::vector<Node>& mutable_items() { return items_; }
  std::vector<Entry>& mutable_entries() { return entries_; }
  void set_text(std::string text) { text_ = std::move(text); }

 private:
  Kind kind_ = Kind::null;
  Origin origin_;
  std::string text_;
  bool quoted_ = false;
  std::vector<Node> items_;
  std::vector<Entry> entries_;
};

struct Node::Entry {
  std::string key;
  Origin key_origin;
  Node value;
};

}  // namespace config
}  // namespace armature
