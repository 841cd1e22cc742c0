// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature {

/// One text for each file that a recording was repaired from or joined of and that was not whole,
/// by its metadata: "it was repaired from 'cut.mcap', which was cut off", "the part of process
/// 'vision' was cut off: it ends before its summary"; empty: nothing was missing in any. `process`:
/// of parts only those of this one; empty: of all.
std::vector<std::string> repairs_told_by(const std::vector<McapMetadata>& metadata,
                                         std::string_view process = {});

/// One text for each component of which a run has not recorded everything, as it says itself;
/// empty: of none.
std::vector<std::string> losses_told_by(const std::vector<McapMetadata>& metadata);

}  // namespace armature
