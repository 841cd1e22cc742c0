// SPDX-License-Identifier: Apache-2.0
#include "armature/config/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "armature/config/source_text.hpp"
#include "armature/config/yaml_parser.hpp"

namespace armature::config {
namespace {

namespace fs = std::filesystem;

/// Includes that include twice each would otherwise read 2^n files.
constexpr int kMaxFiles = 1000;

[[noreturn]] void fail(const Origin& origin, std::string message) {
  throw ConfigError{{{origin, std::move(message)}}};
}

/// Reads a file and all that it includes.
class Loader {
 public:
  Node load(const fs::path& file, const Origin& asked_by) {
    const fs::path real = identity(file);
    const auto first = std::ranges::find(open_, real, &Open::real);
    if (first != open_.end()) refuse_cycle(first, file, asked_by);
    if (++files_read_ > kMaxFiles) {
      fail(asked_by, fmt::format("more than {} files are included", kMaxFiles));
    }
    Node own = parse_document(read_source(file, asked_by), file.string());
    const bool empty = own.kind() == Node::Kind::null && own.text().empty();
    if (own.kind() != Node::Kind::map && !empty) {
      fail(own.origin(), "a configuration file must be a map, not " + own.describe());
    }
    const Node* include = own.find(kInclude);
    if (!include) return own;

    open_.push_back({file, real});
    Node below = Node::map({}, own.origin());
    for (const Node& path : included_paths(*include)) {
      const fs::path target = (file.parent_path() / path.text()).lexically_normal();
      below = merge(below, load(target, path.origin()));
    }
    open_.pop_back();
    std::erase_if(own.mutable_entries(), [](const auto& entry) { return entry.key == kInclude; });
    return merge(below, own);
  }

 private:
  struct Open {
    fs::path written, real;
  };

  static fs::path identity(const fs::path& file) {
    std::error_code ignored;  // a file that is not there is reported when it is read
    fs::path real = fs::weakly_canonical(file, ignored);
    return real.empty() ? file : real;
  }

  [[noreturn]] static void report(const std::vector<std::string>& chain, const Origin& asked_by) {
    fail(asked_by, fmt::format("includes go round in a circle: {}", fmt::join(chain, " -> ")));
  }

  void refuse_cycle(std::vector<Open>::const_iterator first, const fs::path& file,
                    const Origin& asked_by) const {
    std::vector<std::string> chain;
    for (; first != open_.end(); ++first) chain.push_back(first->written.string());
    chain.push_back(file.string());
    report(chain, asked_by);
  }

  static std::vector<Node> included_paths(const Node& include) {
    std::vector<Node> paths;
    if (include.kind() == Node::Kind::sequence) {
      paths.assign(include.items().begin(), include.items().end());
    } else {
      paths.push_back(include);
    }
    for (const Node& path : paths) {
      if (path.kind() != Node::Kind::scalar || path.text().empty()) {
        fail(path.origin(), "'include' must be a path or a list of paths, not " + path.describe());
      }
    }
    return paths;
  }

  std::vector<Open> open_;
  int files_read_ = 0;
};

}  // namespace

Node parse_file(const fs::path& file) {
  return parse_document(read_source(file, Origin{}), file.string());
}

Node parse_text(std::string_view text, std::string_view name) {
  return parse_yaml(std::string{text}, name);
}

Node load(const fs::path& file) {
  const PipeTimeLimit one_for_all;
  return Loader{}.load(file, Origin{});
}

std::filesystem::path folder_of(const Origin& origin) {
  return origin.line == 0 ? std::filesystem::path{}
                          : std::filesystem::path{origin.file}.parent_path();
}

}  // namespace armature::config
