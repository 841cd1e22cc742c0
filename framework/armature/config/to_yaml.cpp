// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "armature/config/document.hpp"

namespace armature::config {
namespace {

constexpr std::size_t kCommentColumn = 48;
constexpr std::size_t kLongestInlineList = 90;

bool is_plain(std::string_view text) {
  constexpr std::string_view kAnywhere = "_./+%()=^-";
  const auto is_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c < 0;
  };
  const auto is_allowed = [&](char c) { return is_word(c) || kAnywhere.find(c) != kAnywhere.npos; };
  if (text.empty() || text == "null" || text == "Null" || text == "NULL") return false;
  const bool begins_well = is_word(text[0]) || text[0] == '.' || text[0] == '/' ||
                           ((text[0] == '-' || text[0] == '+') && text.size() > 1 &&
                            (is_word(text[1]) || text[1] == '.'));
  if (!begins_well || text.starts_with("...") || text.back() == ' ') return false;
  for (std::size_t i = 1; i < text.size(); ++i) {
    const bool inner_colon = text[i] == ':' && i + 1 < text.size() && is_allowed(text[i + 1]);
    if (!is_allowed(text[i]) && text[i] != ' ' && !inner_colon) return false;
  }
  return true;
}

std::string in_double_quotes(std::string_view text) {
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (c == '\r') {
      result += "\\r";
    } else if (c == '$' && text.substr(i).starts_with("${")) {
      result += "\\x24";  // is no variable when it is read again
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string scalar_text(const std::string& text, bool quoted) {
  return !quoted && is_plain(text) ? text : in_double_quotes(text);
}

/// A node that stands on one line, or nothing.
std::string inline_text(const Node& node) {
  switch (node.kind()) {
    case Node::Kind::null: return "null";
    case Node::Kind::scalar: return scalar_text(node.text(), node.quoted());
    case Node::Kind::map: return node.entries().empty() ? "{}" : "";
    case Node::Kind::sequence: break;
  }
  std::string list = "[";
  for (const Node& item : node.items()) {
    const bool same_line =
        item.origin().file == node.origin().file && item.origin().line == node.origin().line;
    if (item.kind() != Node::Kind::scalar || !same_line) return "";
    if (list.size() > 1) list += ", ";
    list += scalar_text(item.text(), item.quoted());
  }
  return list.size() > kLongestInlineList ? "" : list + "]";
}

class Writer {
 public:
  explicit Writer(bool origins) : origins_{origins} {}

  /// `prefix` is what already stands on the first line ("  key:", "  -"), `indent` where the lines
  /// below begin.
  void write(const Node& node, std::string prefix, std::size_t indent) {
    const std::string text = inline_text(node);
    if (!text.empty()) return write_line(prefix.empty() ? text : prefix + " " + text, node);
    if (node.kind() == Node::Kind::map) {
      write_map(node, std::move(prefix), indent);
    } else {
      if (!prefix.empty()) out_ += prefix + "\n";
      for (const Node& item : node.items()) write(item, std::string(indent, ' ') + "-", indent + 2);
    }
  }

  std::string take() { return std::move(out_); }

 private:
  void write_map(const Node& map, std::string prefix, std::size_t indent) {
    const bool in_list = prefix.ends_with("-");
    if (!prefix.empty() && !in_list) out_ += prefix + "\n";
    std::string lead = in_list ? prefix + " " : std::string(indent, ' ');
    for (const Node::Entry& entry : map.entries()) {
      write(entry.value, lead + scalar_text(entry.key, false) + ":", indent + 2);
      lead = std::string(indent, ' ');
    }
  }

  void write_line(std::string line, const Node& node) {
    const std::string origin = origins_ ? node.origin().text() : "";
    if (!origin.empty()) {
      line.resize(std::max(line.size() + 2, kCommentColumn), ' ');
      line += "# " + origin;
    }
    out_ += line + "\n";
  }

  bool origins_;
  std::string out_;
};

}  // namespace

std::string to_yaml(const Node& node, bool origins) {
  Writer writer{origins};
  writer.write(node, "", 0);
  return writer.take();
}

}  // namespace armature::config
