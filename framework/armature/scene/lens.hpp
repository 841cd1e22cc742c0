// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "armature/scene/gaussian_blur.hpp"

namespace armature::scene {

/// What lies between things and the picture of them.
struct ImagingSettings {
  double noise;       // standard deviation, in grey values
  double blur_px;     // sigma of the lens' Gaussian blur
  double background;  // grey value of everything that is not drawn
  Eigen::Vector2d motion_px = Eigen::Vector2d::Zero();  // how far all moves while it is exposed
};

/// A picture before it is exposed: grey values as the light gives them, not limited.
struct Canvas {
  int width = 0, height = 0;  // [px]
  std::vector<float> pixels;

  float* row(int v) {
    return &pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width)];
  }
  PixelRegion whole() const { return {0, 0, width, height}; }
};

/// Blur, motion, noise, and the limits of a sensor: 0 and 255.
class Lens {
 public:
  static constexpr int kWidestImage = 8192;  // [px]

  Lens(const ImagingSettings& settings, std::uint64_t seed);
  /// Blurs what lies in `region`; the rest is of one grey and stays.
  void blur(Canvas& canvas, const PixelRegion& region);
  /// The picture of the canvas. `picture` numbers it for its noise.
  void expose(const Canvas& canvas, std::uint64_t picture, std::span<std::uint8_t> out) const;

 private:
  void smear(Canvas& canvas, const PixelRegion& region);

  GaussianBlur blur_;
  Eigen::Vector2d motion_px_;
  std::uint64_t seed_;
  std::vector<float> noise_;
  std::vector<float> still_;  // the canvas before it is smeared
};

}  // namespace armature::scene
