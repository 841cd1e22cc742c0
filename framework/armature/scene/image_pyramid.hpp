// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "armature/scene/photo.hpp"

namespace armature::scene {

/// A photo at its own resolution, at half of it, at a quarter ...
class ImagePyramid {
 public:
  struct Level {
    int width, height;
    std::vector<float> pixels;
    /// The grey value at (u, v), between four pixels; beyond the edges that of the edge.
    float sample(float u, float v) const {
      u = std::clamp(u, 0.0f, static_cast<float>(width - 1));
      v = std::clamp(v, 0.0f, static_cast<float>(height - 1));
      const int i = std::min(static_cast<int>(u), width - 2);
      const int j = std::min(static_cast<int>(v), height - 2);
      const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
      const float* at = &pixels[static_cast<std::size_t>(j * width + i)];
      const float top = at[0] + a * (at[1] - at[0]);
      const float bottom = at[width] + a * (at[width + 1] - at[width]);
      return top + b * (bottom - top);
    }
    /// True on the pixels of the level, whose centres are at integers.
    bool contains(float u, float v) const {
      return u >= -0.5f && u < static_cast<float>(width) - 0.5f && v >= -0.5f &&
             v < static_cast<float>(height) - 0.5f;
    }
  };

  explicit ImagePyramid(const GrayImage& image);

  const Level& level(int number) const { return levels_[static_cast<std::size_t>(number)]; }
  /// The coarsest level that has at least a pixel for each of a picture that shows `minification`
  /// pixels of the photo in one.
  int level_for(double minification) const;
  /// Pixels of the photo to pixels of a level, homogeneous.
  static Eigen::Matrix3d level_H_photo(int level);

 private:
  std::vector<Level> levels_;
};

}  // namespace armature::scene
