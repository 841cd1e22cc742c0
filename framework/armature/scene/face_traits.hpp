// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace armature::scene {

/// What makes drawn faces differ. As it is value-initialised: the face of seed 1. Lengths are for
/// eyes 63 mm apart.
struct FaceTraits {
  double eyes_to_mouth_mm = 65;  // from the line between the eyes down to the mouth
  double width = 1;              // of the head, as a multiple of the usual one
  double skin = 0, hair = 0;     // grey values brighter than usual
  bool is_bald = false;
  bool has_glasses = false;
  bool has_beard = false;
};

/// The traits of a drawn face. Same seed, same traits.
ARMATURE_EXPORT FaceTraits traits_of(std::uint64_t seed);

}  // namespace armature::scene
