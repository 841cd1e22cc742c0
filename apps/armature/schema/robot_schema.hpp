// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace armature {

/// The JSON Schema of robot files, and of rigs. They judge what is written and not what is missing:
/// a file may stand on another one by `include:`.
nlohmann::ordered_json robot_schema();
nlohmann::ordered_json rig_schema();

}  // namespace armature
