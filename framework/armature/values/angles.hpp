// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace armature {

inline constexpr double kRadPerDegree = std::numbers::pi / 180;
inline constexpr double kDegreesPerRad = 180 / std::numbers::pi;

}  // namespace armature
