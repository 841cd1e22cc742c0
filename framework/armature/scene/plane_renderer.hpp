// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/scene/gaussian_blur.hpp"
#include "armature/scene/photo.hpp"

namespace armature::scene {

/// What lies between the printed plane and the picture of it.
struct ImagingSettings {
  double noise;       // standard deviation, in grey values
  double blur_px;     // sigma of the lens' Gaussian blur
  double background;  // grey value of everything that is not the photo
};

/// Renders a flat photo into a pinhole camera. A plane is seen through a homography, so the picture
/// is exact to the interpolation of the photo: no polygons, no fixed-point coordinates (Hartley and
/// Zisserman, Multiple View Geometry, (8.7)).
class ARMATURE_EXPORT PlaneRenderer {
 public:
  static constexpr int kWidestImage = 8192;  // [px]

  PlaneRenderer(const Photo& photo, const ImagingSettings& settings, std::uint64_t seed);

  /// Draws `width * height` pixels of a camera with the intrinsics of `camera`. The photo's frame:
  /// origin at the mouth, x to the photo's right, y down, z away from who looks at it.
  /// `brightness` multiplies every grey value; `picture` numbers the picture for its noise: same
  /// arguments, same bytes. Nothing of the photo is drawn where it is behind the camera or seen
  /// from behind.
  void render(const Eigen::Isometry3d& camera_T_photo, const StereoCamera& camera,
              double brightness, std::uint64_t picture, std::span<std::uint8_t> out);

 private:
  struct Level {  // of the pyramid: each half as large as the one before
    int width, height;
    std::vector<float> pixels;
    float sample(float u, float v) const;
  };

  PixelRegion covered(const Eigen::Matrix3d& image_H_photo, const StereoCamera& camera) const;
  void draw(const PixelRegion& region, const Eigen::Matrix3d& photo_H_image, const Level& level,
            int samples_per_side, float brightness, float background);
  void quantise(std::uint64_t picture, std::span<std::uint8_t> out) const;

  std::vector<Level> pyramid_;
  Eigen::Vector2d mouth_;
  double m_per_px_;
  ImagingSettings settings_;
  GaussianBlur blur_;
  std::uint64_t seed_;
  std::vector<float> noise_;
  int width_ = 0, height_ = 0;
  std::vector<float> canvas_;
};

}  // namespace armature::scene
