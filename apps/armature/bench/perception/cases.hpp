// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/scene/right_camera.hpp"
#include "armature/scene/scene_renderer.hpp"

namespace armature::bench {

/// One stereo pair of a drawn face, before it is drawn.
struct PerceptionCase {
  std::string group;         // "yaw 15 to 30 deg"
  int number = 0;            // in its group
  StereoCamera camera;       // as it is said to be
  scene::RightCamera right;  // what the right one is besides
  std::uint64_t face_seed = 1;
  std::optional<std::uint64_t> right_face_seed;  // another person, whom the right camera sees alone
  scene::Staging staging = {};
  scene::ImagingSettings imaging{.noise = 2, .blur_px = 0.5, .background = 120};
  std::uint64_t noise_seed = 0;
  double brightness = 1;
  /// Where the face is when the left picture is taken: the truth.
  Eigen::Isometry3d left_T_face = Eigen::Isometry3d::Identity();
  /// Where the pictures show it: elsewhere where a camera is late, sees another face, or the pair
  /// is repeated.
  Eigen::Isometry3d left_shows = left_T_face, right_shows = left_T_face;
  bool continues = false;  // what was remembered of the case before is kept
  bool repeats = false;    // the pictures are those of the case before, to the last bit
};

/// The cases of all groups, group by group, about `pairs` in all and at least one of each group.
/// `camera` is the pair of the groups that have no other. Same seed, same cases; of more pairs the
/// first of each group are those of fewer ones.
std::vector<PerceptionCase> perception_cases(const StereoCamera& camera, int pairs,
                                             std::uint64_t seed);

}  // namespace armature::bench
