// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "armature/config/node.hpp"

namespace armature {

/// `{"file", "line", "column"}`; without lines only the file (`--set ...`, `default of ...`), and
/// nothing of a value that stands nowhere.
nlohmann::ordered_json origin_json(const config::Origin& origin);

/// A document with the place of every value. A map is an object and a list an array; a scalar is
/// `{"value", "origin"}`, as the number, truth or text that it was written as.
nlohmann::ordered_json with_origins(const config::Node& node);

}  // namespace armature
