// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "armature/kinds/face_picture.hpp"
#include "armature/scene/photo.hpp"
#include "bench/perception/cases.hpp"

namespace armature::bench {

/// The pictures of a case, and its truth in the left camera's frame [m].
struct StagedPair {
  Picture left, right;
  scene::FacePoints truth;
};

/// Draws the pictures of cases; keeps the faces that it has drawn.
class Stage {
 public:
  const scene::Photo& photo(std::uint64_t face_seed);
  StagedPair take(const PerceptionCase& one);

 private:
  std::map<std::uint64_t, scene::Photo> photos_;
};

}  // namespace armature::bench
