// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature::config {

/// `text` of a YAML file in which the characters of `${...}` that YAML would read as its own
/// (braces, commas, colons...) are exchanged for control characters, one byte for one byte, so that
/// variables may stand in flow maps and every place stays what it was. `text` must not contain
/// control characters of its own.
std::string mask_variables(std::string text);

/// A parsed scalar with the mask taken off, `${...}` as written.
std::string unmask(std::string_view masked);

/// A parsed scalar with its variables replaced from the environment; an unset one without a default
/// and a bad form are problems at `origin`.
std::string expand_variables(std::string_view masked, const Origin& origin, Problems& problems);

}  // namespace armature::config
