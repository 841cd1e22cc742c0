// SPDX-License-Identifier: Apache-2.0
#include "armature/config/yaml_parser.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>
#include <vector>

#include "armature/config/environment.hpp"
#include "armature/config/problems.hpp"
#include "armature/config/quoted_scalar.hpp"
#include "armature/config/source_text.hpp"
#include "armature/config/tree_builder.hpp"

namespace armature::config {
namespace {

std::size_t byte_of(const YAML::Mark& mark) {
  return static_cast<std::size_t>(std::max(0, mark.pos));
}

/// The events of yaml-cpp as nodes. yaml-cpp says where an event is; the rest (quotes, how a null
/// was written) stands in the text there.
class EventReader : public YAML::EventHandler {
 public:
  EventReader(const SourceText& source, const std::string& masked,
              const std::optional<Origin>& fixed, Problems& problems)
      : source_{source}, masked_{masked}, fixed_{fixed}, problems_{problems}, tree_{problems} {}

  Node root(const Origin& start) const { return tree_.root().value_or(Node::null(start)); }

  Origin place(const YAML::Mark& mark) const { return place(byte_of(mark)); }
  Origin place(std::size_t byte) const { return fixed_ ? *fixed_ : source_.place(byte); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    const bool marked = rest(mark).starts_with("---");
    problems_.add(place(mark), marked ? "a second document starts here; a file holds one"
                                      : "this does not belong to the document above; check its "
                                        "indentation");
    throw ParsingStopped{};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    const std::string written = null_at(mark);
    const std::optional<Origin> key = tree_.pending_key();
    if (key && written.empty() && !has_colon(byte_of(mark))) {
      problems_.add(*key, "a key without ':'; write 'key: value'");
    }
    Node node = Node::null(written.empty() && key ? *key : place(mark));
    node.set_text(written);
    tree_.add(std::move(node));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    problems_.add(place(mark),
                  "aliases ('*name') are not read; repeat the value, use 'include:', or put a text "
                  "in quotes");
    tree_.add(Node::scalar("", true, place(mark)));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    const Origin origin = place(mark);
    const std::string_view written = rest(mark);
    const char quote = tag == "!" && !written.empty() ? written.front() : '\0';
    bool is_sound = true;  // else a control character may look like a masked one
    if (quote == '\'' || quote == '"') {
      if (const auto fault = fault_of_quoted(written)) {
        problems_.add(place(byte_of(mark) + fault->offset), fault->message);
        is_sound = false;
      }
    }
    if (tree_.expects_key()) key_end_ = byte_of(mark) + value.size() + (quote == '\0' ? 0 : 2);
    const bool expands = is_sound && !tree_.expects_key() && (tag != "!" || quote == '"');
    tree_.add(Node::scalar(expands ? expand_variables(value, origin, problems_) : unmask(value),
                           tag == "!", origin));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    open_bracket(mark, style);
    tree_.open_sequence(place(mark));
  }
  void OnSequenceEnd() override {
    open_brackets_.pop_back();
    tree_.close();
  }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    open_bracket(mark, style);
    tree_.open_map(place(mark));
  }
  void OnMapEnd() override {
    open_brackets_.pop_back();
    tree_.close();
  }

  /// The innermost '[' or '{' that is open.
  std::optional<Origin> open_bracket() const {
    const auto open = std::ranges::find_if(open_brackets_.rbegin(), open_brackets_.rend(),
                                           [](const auto& place) { return place.has_value(); });
    return open == open_brackets_.rend() ? std::nullopt : *open;
  }

 private:
  std::string_view rest(const YAML::Mark& mark) const {
    return std::string_view{masked_}.substr(std::min(byte_of(mark), masked_.size()));
  }

  /// True when a colon stands between the last key and `end`.
  bool has_colon(std::size_t end) const {
    end = std::min(end, masked_.size());
    return key_end_ < end && masked_.find(':', key_end_) < end;
  }

  void open_bracket(const YAML::Mark& mark, YAML::EmitterStyle::value style) {
    const bool flow = style == YAML::EmitterStyle::Flow;
    open_brackets_.push_back(flow ? std::optional{place(mark)} : std::nullopt);
  }

  /// `null` or `~` as written at `mark`; empty when the value was left out.
  std::string null_at(const YAML::Mark& mark) const {
    for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
      const std::string_view text = rest(mark);
      if (!text.starts_with(word)) continue;
      const std::string_view after = text.substr(word.size());
      if (after.empty() || std::string_view{" \t\r\n,]}:"}.find(after.front()) != after.npos) {
        return std::string{word};
      }
    }
    return "";
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor == YAML::NullAnchor) return;
    problems_.add(place(mark),
                  "anchors ('&name') are not read; use 'include:', or put a text in quotes");
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    problems_.add(place(mark), fmt::format("tags ({}) are not read; put a text in quotes",
                                           in_quotes(unmask(tag))));
  }

  const SourceText& source_;
  const std::string& masked_;
  const std::optional<Origin>& fixed_;
  Problems& problems_;
  TreeBuilder tree_;
  int documents_ = 0;
  std::size_t key_end_ = 0;                           // the byte behind the last key
  std::vector<std::optional<Origin>> open_brackets_;  // of the open lists and maps; none: indented
};

bool is_indented_by_tab(const std::string& text, std::size_t byte) {
  const std::size_t at = std::min(byte, text.size());
  const std::size_t newline = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t start = newline == std::string::npos ? 0 : newline + 1;
  const std::size_t tab = text.find('\t', start);
  return tab < text.find_first_not_of(" \t", start);
}

/// yaml-cpp's message with what usually is behind it.
Problem explained(const YAML::Exception& error, const EventReader& events,
                  const std::string& text) {
  const Origin place = events.place(error.mark);
  const std::string message = "cannot be read as YAML: " + error.msg;
  const bool not_closed =
      error.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW || error.msg == YAML::ErrorMsg::END_OF_MAP_FLOW;
  if (const auto open = events.open_bracket(); open && not_closed) {
    return {*open, message + "; what opens here is not closed"};
  }
  if (is_indented_by_tab(text, byte_of(error.mark))) {
    return {place, message + "; indent with spaces, not tabs"};
  }
  if (error.msg == YAML::ErrorMsg::MAP_VALUE) {
    return {place, message + "; check the indentation, and put a text that holds ': ' in quotes"};
  }
  if (error.msg == YAML::ErrorMsg::UNKNOWN_TOKEN || error.msg == YAML::ErrorMsg::UNKNOWN_ANCHOR) {
    return {place, message + "; put a text in quotes"};
  }
  return {place, message};
}

/// Refuses XML, which is what a robot's description is handed over as by others.
void refuse_xml(const std::string& text, const Origin& place) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || text[first] != '<' || text[first + 1] == '<') return;
  const bool is_xacro = text.find("xacro:") != std::string::npos;
  throw ConfigError{{{place, is_xacro ? "a xacro file, not YAML: run 'xacro FILE > arm.urdf', and "
                                        "name that in a robot file, 'urdf: arm.urdf'"
                                      : "an XML file, not YAML; a URDF file is named in a robot "
                                        "file, 'urdf: arm.urdf'"}}};
}

}  // namespace

Node parse_yaml(std::string text, std::string_view name, const std::optional<Origin>& origin) {
  if (!text.ends_with('\n')) text += '\n';
  refuse_xml(text, origin.value_or(Origin{std::string{name}, 1, 1}));
  const SourceText source{std::move(text), std::string{name}};
  const std::string masked = mask_variables(source.text());
  Problems problems;
  EventReader events{source, masked, origin, problems};
  try {
    std::istringstream stream{masked};
    YAML::Parser parser{stream};
    while (parser.HandleNextDocument(events)) {
    }
  } catch (const ParsingStopped&) {
  } catch (const YAML::Exception& error) {
    // What was seen before may itself be a consequence, so it stands alone.
    throw ConfigError{{explained(error, events, source.text())}};
  }
  problems.throw_if_any();
  return events.root(events.place(0));
}

Node parse_document(std::string text, std::string_view name) {
  Node document = parse_yaml(std::move(text), name);
  if (document.kind() == Node::Kind::scalar) {
    throw ConfigError{{{document.origin(), "a configuration file must be a map, not a text"}}};
  }
  const auto is_name = [](std::string_view key) {
    return std::ranges::all_of(key, [](unsigned char c) {
      return std::isalnum(c) || c >= 0x80 ||
             std::string_view{"_-./ "}.find(static_cast<char>(c)) != std::string_view::npos;
    });
  };
  for (const Node::Entry& entry : document.entries()) {
    if (is_name(entry.key)) continue;
    throw ConfigError{
        {{entry.key_origin, "this is no key of a configuration file (and is not shown here)"}}};
  }
  return document;
}

}  // namespace armature::config
