// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// Describes the types of `idl` to this process. A type that is described already must be the same.
/// The reason names file and line; nothing is described then.
Expected<void> add_descriptions(std::string_view idl, std::string_view file);

/// A type by ROS or DDS name, of a message library that is loaded or of add_descriptions();
/// nullptr: unknown. What it points to stays.
const TypeDescription* describe_type(std::string_view name);

}  // namespace armature
