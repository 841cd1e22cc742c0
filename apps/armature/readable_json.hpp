// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace armature {

/// JSON for people: what fits into a line, and every list of plain values, is in one line; the rest
/// is indented.
std::string readable(const nlohmann::ordered_json& json);

}  // namespace armature
