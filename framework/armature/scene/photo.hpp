// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace armature::scene {

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

}  // namespace armature::scene
