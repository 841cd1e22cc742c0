// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/image_pyramid.hpp"

#include <cmath>
#include <utility>

namespace armature::scene {
namespace {

constexpr int kSmallestLevel = 16;  // px

}  // namespace

ImagePyramid::ImagePyramid(const GrayImage& image) {
  Level level{image.width, image.height, {}};
  level.pixels.assign(image.pixels.begin(), image.pixels.end());
  levels_.push_back(std::move(level));
  while (levels_.back().width >= 2 * kSmallestLevel &&
         levels_.back().height >= 2 * kSmallestLevel) {
    const Level& fine = levels_.back();
    Level coarse{fine.width / 2, fine.height / 2, {}};
    for (int v = 0; v < coarse.height; ++v) {
      for (int u = 0; u < coarse.width; ++u) {
        const float* at = &fine.pixels[static_cast<std::size_t>(2 * v * fine.width + 2 * u)];
        coarse.pixels.push_back(0.25f * (at[0] + at[1] + at[fine.width] + at[fine.width + 1]));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

int ImagePyramid::level_for(double minification) const {
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(minification, 1.0)))), 0,
                    static_cast<int>(levels_.size()) - 1);
}

// Pixel (u, v) of level k covers the pixels from 2^k u on: its centre is at 2^k (u + 1/2) - 1/2.
Eigen::Matrix3d ImagePyramid::level_H_photo(int level) {
  const double scale = std::ldexp(1.0, -level);
  Eigen::Matrix3d h;
  h << scale, 0, 0.5 * scale - 0.5, 0, scale, 0.5 * scale - 0.5, 0, 0, 1;
  return h;
}

}  // namespace armature::scene
