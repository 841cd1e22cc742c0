// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace armature::scene {

/// Pixels from (left, top) to before (right, bottom).
struct ARMATURE_EXPORT PixelRegion {
  int left = 0, top = 0, right = 0, bottom = 0;

  bool empty() const { return left >= right || top >= bottom; }
  /// The region with `margin` more on all sides, within a picture.
  PixelRegion grown(int margin, int width, int height) const;
};

/// Blurs a picture along its rows and its columns with a Gaussian that is cut off at 3 sigma. Keeps
/// its memory from picture to picture.
class ARMATURE_EXPORT GaussianBlur {
 public:
  explicit GaussianBlur(double sigma_px);
  /// How far a pixel is spread [px].
  int reach() const { return static_cast<int>(weights_.size()) - 1; }
  /// Blurs `region` of a picture in rows of `width`; beyond the picture's edges its outermost
  /// pixels go on. Pixels outside the region are read and not written. Allocates when the region is
  /// larger than all before.
  void apply(std::span<float> picture, int width, const PixelRegion& region);

 private:
  void along_rows(std::span<const float> picture, int width, const PixelRegion& rows);

  std::vector<float> weights_;  // of the middle, of its neighbours, of theirs ...
  std::vector<float> row_, rows_;
};

}  // namespace armature::scene
