// SPDX-License-Identifier: Apache-2.0
#include "section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace armature::monitor::sections {
namespace {

using Eigen::Vector3d;

struct Axes {
  Vector3d right, down;
};

/// As radiologists look at a patient in LPS (x to his left, y to his back, z to his head).
Axes axes_of(View view) {
  const Vector3d left = Vector3d::UnitX(), back = Vector3d::UnitY(), feet = -Vector3d::UnitZ();
  if (view == View::axial) return {left, back};
  if (view == View::coronal) return {left, feet};
  return {back, feet};
}

}  // namespace

Vector3d Section::seen(const Vector3d& point) const {
  const Vector3d out = point - corner;
  return {out.dot(right) / pixel, out.dot(down) / pixel, -out.dot(right.cross(down))};
}

Section section_through(View view, const Vector3d& point, const VolumeGeometry& geometry,
                        double width, int size) {
  const auto [right, down] = axes_of(view);
  Eigen::Vector3d last;
  for (int axis = 0; axis < 3; ++axis) {
    last[axis] = geometry.size[static_cast<std::size_t>(axis)] - 1;
  }
  const Vector3d middle = geometry.point_at(0.5 * last), normal = right.cross(down);
  const Vector3d centre = middle + normal.dot(point - middle) * normal;
  Section section{
      .corner = centre, .right = right, .down = down, .pixel = width / size, .size = size};
  section.corner -= 0.5 * (size - 1) * section.pixel * (right + down);
  return section;
}

std::vector<std::uint8_t> grey_values(const Volume& volume, const Section& section, double black,
                                      double white) {
  std::vector<std::uint8_t> values;
  values.reserve(static_cast<std::size_t>(section.size) * static_cast<std::size_t>(section.size));
  for (int v = 0; v < section.size; ++v) {
    for (int u = 0; u < section.size; ++u) {
      const double share =
          (hounsfield_at(volume, section.point_at(u, v)) - black) / (white - black);
      values.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
    }
  }
  return values;
}

}  // namespace armature::monitor::sections
