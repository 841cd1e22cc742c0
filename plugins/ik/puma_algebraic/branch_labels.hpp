// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace armature {

// Shoulder 0: the wrist lies ahead of link 1. Elbow 0: t3 + atan2(d4, a3) >= 0. Wrist 0: t5 >= 0.
inline constexpr std::array<std::string_view, 8> kLabels{
    "shoulder0/elbow0/wrist0", "shoulder0/elbow0/wrist1", "shoulder0/elbow1/wrist0",
    "shoulder0/elbow1/wrist1", "shoulder1/elbow0/wrist0", "shoulder1/elbow0/wrist1",
    "shoulder1/elbow1/wrist0", "shoulder1/elbow1/wrist1"};

// Roots of the roll over the depth, counted from shallow to deep.
inline constexpr std::array<std::string_view, 32> kDepthLabels{
    "shoulder0/elbow0/wrist0/depth0", "shoulder0/elbow0/wrist0/depth1",
    "shoulder0/elbow0/wrist0/depth2", "shoulder0/elbow0/wrist0/depth3",
    "shoulder0/elbow0/wrist1/depth0", "shoulder0/elbow0/wrist1/depth1",
    "shoulder0/elbow0/wrist1/depth2", "shoulder0/elbow0/wrist1/depth3",
    "shoulder0/elbow1/wrist0/depth0", "shoulder0/elbow1/wrist0/depth1",
    "shoulder0/elbow1/wrist0/depth2", "shoulder0/elbow1/wrist0/depth3",
    "shoulder0/elbow1/wrist1/depth0", "shoulder0/elbow1/wrist1/depth1",
    "shoulder0/elbow1/wrist1/depth2", "shoulder0/elbow1/wrist1/depth3",
    "shoulder1/elbow0/wrist0/depth0", "shoulder1/elbow0/wrist0/depth1",
    "shoulder1/elbow0/wrist0/depth2", "shoulder1/elbow0/wrist0/depth3",
    "shoulder1/elbow0/wrist1/depth0", "shoulder1/elbow0/wrist1/depth1",
    "shoulder1/elbow0/wrist1/depth2", "shoulder1/elbow0/wrist1/depth3",
    "shoulder1/elbow1/wrist0/depth0", "shoulder1/elbow1/wrist0/depth1",
    "shoulder1/elbow1/wrist0/depth2", "shoulder1/elbow1/wrist0/depth3",
    "shoulder1/elbow1/wrist1/depth0", "shoulder1/elbow1/wrist1/depth1",
    "shoulder1/elbow1/wrist1/depth2", "shoulder1/elbow1/wrist1/depth3"};

}  // namespace armature
