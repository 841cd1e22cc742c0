// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature::config {

/// Reads one YAML file (or text) strictly: one document, no duplicate keys, no anchors' surprises
/// (`<<` merges are refused with a hint to `include:`), `${NAME}` and `${NAME:-default}` replaced
/// from the environment in unquoted and double-quoted scalars. Throws ConfigError.
Node parse_file(const std::filesystem::path& file);
Node parse_text(std::string_view text, std::string_view name);

/// `parse_file`, with the file's own `include:` (one path or a list, relative to the including
/// file; later ones and the file itself override) resolved. A cycle of includes is an error.
Node load(const std::filesystem::path& file);

/// The files merged in order (an overlay's maps merge into the map below, everything else
/// replaces; an explicit null removes the key) and then the `--set path.to.key=value` assignments.
/// A `--set` value is parsed as YAML; its origin is the option itself.
Node load_with_overlays(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& assignments);

/// `overlay` merged over `base`, by the rules of `load_with_overlays`.
Node merge(const Node& base, const Node& overlay);

/// YAML text of a node; with `origins`, every scalar is followed by `# file:line:column`.
std::string to_yaml(const Node& node, bool origins);

}  // namespace armature::config
