// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "armature/volume/volume.hpp"

namespace armature::monitor::sections {

/// The picture's plane in the image's frame: square, `size` pixels wide and high.
struct Section {
  Eigen::Vector3d corner;       // [m] of the upper left pixel's centre
  Eigen::Vector3d right, down;  // unit vectors along rows and columns
  double pixel = 0;             // [m]
  int size = 0;

  Eigen::Vector3d point_at(double u, double v) const {
    return corner + pixel * (u * right + v * down);
  }
  /// Where a point is seen [px], and how far it is before the plane (towards who looks) [m].
  Eigen::Vector3d seen(const Eigen::Vector3d& point) const;
};

enum class View { axial, coronal, sagittal };

/// Through `point`, about the middle of a volume, `width` [m] across.
Section section_through(View view, const Eigen::Vector3d& point, const VolumeGeometry& geometry,
                        double width, int size);

/// Grey values, row by row: `black` and below is 0, `white` and above 255 [Hounsfield units].
std::vector<std::uint8_t> grey_values(const Volume& volume, const Section& section, double black,
                                      double white);

}  // namespace armature::monitor::sections
