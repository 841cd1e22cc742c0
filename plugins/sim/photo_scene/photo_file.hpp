// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "armature/scene/photo.hpp"
#include "armature/values/expected.hpp"

namespace armature::sim::photo_scene {

/// Reads a PNG or JPEG as mono8 and scales it so that the eyes are `eye_distance_m` apart.
Expected<scene::Photo> read_photo(const std::string& file, const Eigen::Vector2d& left_eye,
                                  const Eigen::Vector2d& right_eye, const Eigen::Vector2d& mouth,
                                  double eye_distance_m);

}  // namespace armature::sim::photo_scene
