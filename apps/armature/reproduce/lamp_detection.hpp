// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/results.hpp"

namespace armature::reproduce {

/// How often a face is found in both pictures of a pair, by the angle between its normal and the
/// line of sight: the tables `detection_aside` and `detection_upright` [%] and the figure
/// `detection`. Takes minutes.
void add_detection(Results& results);

}  // namespace armature::reproduce
