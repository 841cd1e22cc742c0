// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "armature/kinds/image_view.hpp"

namespace armature::face_pose::surface {

/// A part of a picture in floating point: `step` x `step` pixels averaged into one, then smoothed
/// by (1 2 1) / 4 along rows and columns. Between pixels it is a cubic B-spline of their values,
/// which smooths by the same amount wherever a point lies between them (Unser 1999, "Splines: a
/// perfect fit for signal and image processing"). A mean of the neighbours smooths most half-way
/// between two pixels, and what that changes is taken for a disparity.
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
  float value(float u, float v) const;
  /// The same with its derivatives.
  Sample sample(float u, float v) const;
  /// At most how many times the variance of a mean over many pixels is what it would be if the
  /// noise of each were its own, where every `stride`th one of those that are averaged counts:
  /// neighbours share the noise of what both were smoothed from.
  static double shared_noise(double stride);

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
