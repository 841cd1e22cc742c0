// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// Why `name` names no topic, as ROS 2 has them: words of letters, digits and underscores, none
/// beginning with a digit, with '/' between them; a '/' in front makes it absolute.
std::optional<std::string> topic_name_defect(std::string_view name);

}  // namespace armature
