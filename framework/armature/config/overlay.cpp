// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <utility>

#include "armature/config/document.hpp"
#include "armature/config/source_text.hpp"
#include "armature/config/yaml_parser.hpp"

namespace armature::config {
namespace {

bool is_map(const Node& node) { return node.kind() == Node::Kind::map; }
bool removes(const Node& node) { return node.kind() == Node::Kind::null && !node.text().empty(); }
bool has_no_value(const Node& node) {
  return node.kind() == Node::Kind::null && node.text().empty();
}

std::vector<std::string> keys_of(const Node& map) {
  std::vector<std::string> keys;
  for (const Node::Entry& entry : map.entries()) keys.push_back(entry.key);
  return keys;
}

void nothing_to_remove(const std::string& key, const Node& map, const Origin& origin,
                       Problems& problems) {
  problems.add(origin, fmt::format("there is no {} to remove{}", in_quotes(key),
                                   did_you_mean(key, keys_of(map))));
}

/// Whether both say which plugin, and not the same.
bool names_another_plugin(const Node* before, const Node* now) {
  const auto is_id = [](const Node* node) { return node && node->kind() == Node::Kind::scalar; };
  return is_id(before) && is_id(now) && before->text() != now->text();
}

/// Takes out the parameters of a plugin whose place another one takes: all but those that
/// `replacement` speaks of, and those that the command line said. Their names.
std::vector<std::string> drop_params(Node& map, const Node* replacement) {
  std::vector<std::string> dropped;
  auto& entries = map.mutable_entries();
  const auto params = std::ranges::find(entries, "params", &Node::Entry::key);
  if (params == entries.end() || !is_map(params->value)) return dropped;
  std::erase_if(params->value.mutable_entries(), [&](const Node::Entry& entry) {
    const bool is_said = entry.value.origin().line == 0;
    if (is_said || (replacement && replacement->find(entry.key))) return false;
    dropped.push_back(entry.key);
    return true;
  });
  return dropped;
}

Node merged(const Node& lower, const Node& overlay, Problems& problems) {
  if (!is_map(lower) || !is_map(overlay)) return overlay;

  Node base = lower;
  if (names_another_plugin(base.find("plugin"), overlay.find("plugin"))) {
    drop_params(base, overlay.find("params"));
  }
  std::unordered_map<std::string_view, const Node::Entry*> above;
  for (const Node::Entry& entry : overlay.entries()) above.emplace(entry.key, &entry);
  std::vector<Node::Entry> entries;
  for (const Node::Entry& below : base.entries()) {
    const auto found = above.find(below.key);
    if (found == above.end()) {
      entries.push_back(below);
      continue;
    }
    const Node::Entry& entry = *found->second;
    above.erase(found);
    if (removes(entry.value)) continue;
    if (has_no_value(entry.value) && !has_no_value(below.value)) {
      problems.add(entry.key_origin,
                   fmt::format("{} has no value here; leave it out to keep what stands at {}, or "
                               "write null to remove it",
                               in_quotes(entry.key), below.key_origin.text()));
      continue;
    }
    entries.push_back({below.key, below.key_origin, merged(below.value, entry.value, problems)});
  }
  for (const Node::Entry& entry : overlay.entries()) {
    if (!above.contains(entry.key)) continue;
    if (removes(entry.value)) {
      nothing_to_remove(entry.key, base, entry.key_origin, problems);
    } else {
      entries.push_back(entry);
    }
  }
  return Node::map(std::move(entries), base.origin());
}

/// One `--set path.to.key=value`.
class Assignment {
 public:
  Assignment(const std::string& option, Problems& problems, std::vector<std::string>* notes)
      : origin_{origin_of(option)}, problems_{problems}, notes_{notes} {
    const std::size_t equals = option.find('=');
    const std::string fault = equals == std::string::npos ? "must be path.to.key=value"
                                                          : read_path(option.substr(0, equals));
    if (!fault.empty()) {
      complain(fault);
      return;
    }
    if (keys_.front() == kInclude) {
      complain("'include' stands in a file; name the other file on the command line instead");
      return;
    }
    value_ = parse_yaml(option.substr(equals + 1), origin_.file, origin_);
    if (has_no_value(value_)) {
      complain("has no value; write null to remove the key, or \"\" for an empty text");
    }
    good_ = !has_no_value(value_);
  }

  void apply(Node& root) const {
    if (good_) apply(root, 0);
  }

 private:
  static Origin origin_of(const std::string& option) {
    const std::string quoted = in_quotes(option);
    return {"--set " + quoted.substr(1, quoted.size() - 2), 0, 0};
  }

  /// What is wrong with the path; empty: nothing.
  std::string read_path(const std::string& text) {
    constexpr std::size_t kMaxParts = 100;
    std::size_t start = 0;
    while (start <= text.size()) {
      const std::size_t end = std::min(text.find('.', start), text.size());
      if (end == start) return "the path has an empty part; it must be path.to.key=value";
      keys_.push_back(text.substr(start, end - start));
      start = end + 1;
    }
    return keys_.size() > kMaxParts ? "the path is longer than 100 parts" : "";
  }

  void complain(std::string message) const { problems_.add(origin_, std::move(message)); }

  std::string path(std::size_t count) const {
    std::string text = keys_.front();
    for (std::size_t i = 1; i < count; ++i) text += "." + keys_[i];
    return in_quotes(text);
  }

  /// Walks from `node`, which stands at the first `depth` keys.
  void apply(Node& node, std::size_t depth) const {
    if (node.kind() == Node::Kind::null) node = Node::map({}, origin_);
    if (is_map(node)) {
      apply_to_map(node, depth);
    } else if (node.kind() == Node::Kind::sequence) {
      apply_to_list(node, depth);
    } else {
      complain(fmt::format("{} is {} ({}), which has no keys", path(depth), node.describe(),
                           node.origin().text()));
    }
  }

  /// One word puts another plugin there: what was written for the one before is told and goes.
  void swap_plugin(Node& map, const Node& before) const {
    const std::string was = before.text();
    const std::vector<std::string> dropped = drop_params(map, nullptr);
    if (dropped.empty() || !notes_) return;
    std::string place = keys_.front();
    for (std::size_t i = 1; i + 1 < keys_.size(); ++i) place += "." + keys_[i];
    notes_->push_back(fmt::format(
        "{}: left out what was written for {}: {}; give what is meant for {} as well with --set "
        "{}.params.NAME=VALUE",
        origin_.text(), in_quotes(was), fmt::join(dropped, ", "), in_quotes(value_.text()), place));
  }

  void apply_to_map(Node& map, std::size_t depth) const {
    const std::string& key = keys_[depth];
    if (depth > 0 && depth + 1 == keys_.size() && key == "plugin") {
      const Node* before = map.find("plugin");
      if (names_another_plugin(before, &value_)) swap_plugin(map, Node{*before});
    }
    auto& entries = map.mutable_entries();
    const auto entry = std::ranges::find(entries, key, &Node::Entry::key);
    const bool last = depth + 1 == keys_.size();
    if (last && removes(value_)) {
      if (entry == entries.end()) return nothing_to_remove(key, map, origin_, problems_);
      entries.erase(entry);
    } else if (entry == entries.end()) {
      entries.push_back({key, origin_, last ? value_ : Node::map({}, origin_)});
      if (!last) apply(entries.back().value, depth + 1);
    } else {
      set(entry->value, depth);
    }
  }

  void apply_to_list(Node& list, std::size_t depth) const {
    const std::string& key = keys_[depth];
    auto& items = list.mutable_items();
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error != std::errc{} || end != key.data() + key.size() || index >= items.size()) {
      return complain(
          fmt::format("{} is a list of {}; {} is not one of its indices, which count "
                      "from 0",
                      path(depth), items.size(), in_quotes(key)));
    }
    if (depth + 1 == keys_.size() && removes(value_)) {
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(index));
    } else {
      set(items[index], depth);
    }
  }

  void set(Node& below, std::size_t depth) const {
    if (depth + 1 == keys_.size()) {
      below = merged(below, value_, problems_);
    } else {
      apply(below, depth + 1);
    }
  }

  Origin origin_;
  Problems& problems_;
  std::vector<std::string>* notes_;
  std::vector<std::string> keys_;
  Node value_ = Node::null({});
  bool good_ = false;
};

}  // namespace

Node merge(const Node& base, const Node& overlay) {
  if (has_no_value(overlay)) return base;
  Problems problems;
  Node result = merged(base, overlay, problems);
  problems.throw_if_any();
  return result;
}

Node load_with_overlays(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& assignments,
                        std::vector<std::string>* notes) {
  const PipeTimeLimit one_for_all;
  Node document = Node::null({});
  for (const std::filesystem::path& file : files) {
    document = document.kind() == Node::Kind::null ? load(file) : merge(document, load(file));
  }
  return with_assignments(std::move(document), assignments, notes);
}

Node with_assignments(Node document, const std::vector<std::string>& assignments,
                      std::vector<std::string>* notes) {
  Problems problems;
  for (const std::string& option : assignments) {
    try {
      Assignment{option, problems, notes}.apply(document);
    } catch (const ConfigError& error) {  // the value is not YAML
      for (const Problem& problem : error.problems()) problems.add(problem.origin, problem.message);
    }
  }
  problems.throw_if_any();
  return document;
}

}  // namespace armature::config
