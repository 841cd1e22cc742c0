// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "armature/kinds/image_view.hpp"

namespace armature::landmarks::face_mesh {

/// A square of an image [px].
struct Crop {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double side = 0;

  /// Where a place [px] of the square that was resampled to `pixels` x `pixels` is in the image.
  Eigen::Vector2d in_image(const Eigen::Vector2d& at, int pixels) const {
    return middle + (at.array() - 0.5 * (pixels - 1)).matrix() * (side / pixels);
  }
};

/// Resamples `crop` to `pixels` x `pixels` grey values of 0 to 1, row by row; `grey` has room for
/// them. A value is the mean of as many places as the image has pixels there (at most 8 x 8), so
/// that none is skipped; outside of the image its edge goes on. Real-time safe.
void cut(const ImageView& image, const Crop& crop, int pixels, std::span<float> grey);

}  // namespace armature::landmarks::face_mesh
