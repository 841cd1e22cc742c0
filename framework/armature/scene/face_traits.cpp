// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/face_traits.hpp"

#include "armature/scene/splitmix.hpp"
#include "armature/values/chance.hpp"

namespace armature::scene {

FaceTraits traits_of(std::uint64_t seed) {
  if (seed == 1) return {};
  std::uint64_t drawn = seed;
  const auto draw = [&] {
    drawn = splitmix(drawn);
    return share_of(drawn);
  };
  const auto between = [&](double low, double high) { return low + (high - low) * draw(); };
  FaceTraits traits;
  traits.eyes_to_mouth_mm = between(59, 71);
  traits.width = between(0.93, 1.08);
  traits.skin = between(-40, 20);
  traits.hair = between(-15, 75);
  traits.is_bald = draw() < 0.2;
  traits.has_glasses = draw() < 0.35;
  traits.has_beard = draw() < 0.3;
  return traits;
}

}  // namespace armature::scene
