// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "armature/config/node.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {

/// One YAML document as nodes, by the rules of `parse_text`. With `origin`, every node comes from
/// there (a value of `--set`), else from its line and column in the text called `name`. Throws
/// ConfigError.
Node parse_yaml(std::string text, std::string_view name,
                const std::optional<Origin>& origin = std::nullopt);

/// The same for the text of a file, which may be any file that the user named by mistake: what is
/// plain text, or a map whose keys are no names (/etc/shadow is one), is refused without being
/// shown.
Node parse_document(std::string text, std::string_view name);

}  // namespace config
}  // namespace armature
