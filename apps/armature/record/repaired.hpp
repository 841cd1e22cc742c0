// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature {

/// One text for each file that a recording was repaired from and that was not whole, by its
/// metadata: "it was repaired from 'cut.mcap', which was cut off"; empty: nothing was missing in
/// any.
std::vector<std::string> repairs_told_by(const std::vector<McapMetadata>& metadata);

}  // namespace armature
