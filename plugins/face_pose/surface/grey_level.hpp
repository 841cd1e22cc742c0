// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "armature/kinds/image_view.hpp"

namespace armature::face_pose::surface {

/// A part of a picture in floating point: `step` x `step` pixels averaged into one, then smoothed
/// by (1 2 1) / 4 along rows and columns, so that what lies between pixels can be interpolated.
class GreyLevel {
 public:
  /// A grey value between pixels, and its derivatives by the picture's columns and rows [1/px].
  struct Sample {
    float value, by_u, by_v;
  };

  /// Takes the part of `image` that lies in `part`. Allocates only to become larger.
  void cut(const ImageView& image, const PixelBox& part, int step);

  int step() const { return step_; }
  /// Whether the picture's point (u, v) [px] can be sampled.
  bool covers(float u, float v) const {
    const float x = column(u), y = row(v);
    return x >= 1 && y >= 1 && x < static_cast<float>(width_ - 2) &&
           y < static_cast<float>(height_ - 2);
  }
  /// Needs `covers(u, v)`.
  float value(float u, float v) const {
    const float x = column(u), y = row(v);
    const auto i = static_cast<int>(x), j = static_cast<int>(y);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const float* at = pixel(i, j);
    const float top = at[0] + a * (at[1] - at[0]);
    const float bottom = at[width_] + a * (at[width_ + 1] - at[width_]);
    return top + b * (bottom - top);
  }
  /// The same with derivatives: of the differences over two pixels, interpolated like the values.
  Sample sample(float u, float v) const;

 private:
  float column(float u) const { return (u - first_u_) * per_step_; }
  float row(float v) const { return (v - first_v_) * per_step_; }
  const float* pixel(int i, int j) const {
    return &pixels_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(i)];
  }
  void smooth();

  int step_ = 1, width_ = 0, height_ = 0;
  float per_step_ = 1;
  float first_u_ = 0, first_v_ = 0;  // [px] of the picture: the middle of the first pixel
  std::vector<float> pixels_, scratch_;
};

}  // namespace armature::face_pose::surface
