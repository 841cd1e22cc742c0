// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature {

/// What a recording's metadata say of the files that it was repaired from and that were not whole,
/// "it was repaired from 'cut.mcap', which was cut off"; empty: nothing was missing in any.
std::vector<std::string> repairs_told_by(const std::vector<McapMetadata>& metadata);

}  // namespace armature
