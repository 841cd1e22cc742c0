// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "armature/scene/photo.hpp"

namespace armature::scene {

/// Draws a face with fine skin texture from `seed`, its eyes `eye_distance_m` apart; eyes and mouth
/// are where they were drawn. Takes a few hundredths of a second and allocates.
ARMATURE_EXPORT Photo generated_face(std::uint64_t seed, double eye_distance_m);

}  // namespace armature::scene
