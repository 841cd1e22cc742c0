// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature::sim::photo_scene {

/// A mono8 image without padding.
struct GrayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  std::uint8_t at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
};

/// A printed face: the picture, its size and where its features are, [px], pixel centres at
/// integers. "left" is the picture's left.
struct Photo {
  GrayImage image;
  Eigen::Vector2d left_eye, right_eye, mouth;
  double m_per_px = 0;
};

/// Reads a PNG or JPEG as mono8 and scales it so that the eyes are `eye_distance_m` apart.
Expected<Photo> read_photo(const std::string& file, const Eigen::Vector2d& left_eye,
                           const Eigen::Vector2d& right_eye, const Eigen::Vector2d& mouth,
                           double eye_distance_m);

/// Draws a face with fine skin texture from `seed`; eyes and mouth are where they were drawn.
Photo generated_face(std::uint64_t seed, double eye_distance_m);

}  // namespace armature::sim::photo_scene
