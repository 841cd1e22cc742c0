// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// Reads one YAML file (or text) strictly: UTF-8, one document, no duplicate keys, nesting up to
/// 100 levels; anchors, tags and `<<` merges are refused. `${NAME}` and `${NAME:-default}` are
/// replaced from the environment in unquoted and double-quoted scalars, also inside `{}` and `[]`;
/// the default stands for an unset or empty variable. An empty document is a null node. Throws
/// ConfigError.
Node parse_file(const std::filesystem::path& file);
Node parse_text(std::string_view text, std::string_view name);

/// The key at the top of a file that names those it stands upon.
inline constexpr std::string_view kInclude = "include";

/// `parse_file`, with the file's own `include:` (one path or a list, relative to the including
/// file; later ones and the file itself override) resolved. A cycle of includes is an error.
Node load(const std::filesystem::path& file);

/// `document` with `--set path.to.key=value` assignments made (`a.0.b` reaches into a list; maps
/// that are missing on the way are made). A `--set` value is parsed as YAML; its origin is the
/// option itself. What a `--set ...plugin=` leaves out is told in `notes`, one sentence each.
/// Throws ConfigError.
Node with_assignments(Node document, const std::vector<std::string>& assignments,
                      std::vector<std::string>* notes = nullptr);

/// The files, each with its includes, merged in order and then the assignments. Throws ConfigError.
Node load_with_overlays(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& assignments,
                        std::vector<std::string>* notes = nullptr);

/// `overlay` merged over `base`: maps merge key by key, everything else replaces. An explicit null
/// removes the key below (which must be there); a key without a value is refused where it would
/// hide something. Where both have a `plugin:` and not the same one, the `params:` below go, except
/// those that the command line said. An empty overlay changes nothing. Throws ConfigError.
Node merge(const Node& base, const Node& overlay);

/// YAML text of a node, which reads back as the same node; with `origins`, every scalar (or list of
/// scalars that was written on one line) is followed by `# file:line:column`.
std::string to_yaml(const Node& node, bool origins);

/// What a relative path written at `origin` is relative to: the file's folder, or for a place
/// without lines (`--set`, a default) the current one.
std::filesystem::path folder_of(const Origin& origin);

}  // namespace config
}  // namespace armature
