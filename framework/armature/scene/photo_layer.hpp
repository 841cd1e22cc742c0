// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/scene/image_pyramid.hpp"
#include "armature/scene/photo.hpp"
#include "armature/scene/surface.hpp"
#include "armature/scene/view.hpp"

namespace armature::scene {

/// Draws a photo that is glued to a surface into a pinhole camera, over what is there.
///
/// A plane is seen through a homography (Hartley and Zisserman, Multiple View Geometry, (8.7)), a
/// cylinder or a sphere is met by the ray of every pixel: the picture is exact to the interpolation
/// of the photo, without polygons. Nothing of the photo is drawn where it is behind the camera or
/// seen from behind.
class PhotoLayer {
 public:
  PhotoLayer(const Photo& photo, const Surface& surface);
  /// The region that was drawn into.
  PixelRegion draw(Canvas& canvas, const View& view);

 private:
  void draw_flat(Canvas& canvas, const PixelRegion& region, const Eigen::Matrix3d& photo_H_image,
                 const ImagePyramid::Level& level, int samples_per_side, float brightness);
  void draw_curved(Canvas& canvas, const View& view, const PixelRegion& region, int level) const;
  PixelRegion covered_by_plane(const Eigen::Matrix3d& image_H_photo, const View& view) const;
  std::vector<Eigen::Vector3d> hull() const;

  ImagePyramid pyramid_;
  Surface surface_;
  Eigen::Vector2d mouth_;
  double m_per_px_;
  std::vector<float> under_;  // what a row showed before
};

}  // namespace armature::scene
