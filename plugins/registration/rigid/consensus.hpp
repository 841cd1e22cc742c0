// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/kinds/registration/registration.hpp"

namespace armature::registration::rigid {

/// The markers that agree with each other: no one of them is missed by more than `outlier_m` by the
/// motion that fits them best. All if they do; else the largest set, at least four, that one motion
/// through three of them gathers, found by trying all threes. Refuses when there is none, or two
/// as large. Allocates.
Expected<std::vector<bool>> agreeing_markers(const MarkerPairs& markers, double outlier_m);

}  // namespace armature::registration::rigid
