// SPDX-License-Identifier: Apache-2.0
#include "frontal_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "armature/kinds/landmarks/stretched_image.hpp"
#include "feature_plane.hpp"

namespace armature::face_pose::surface {
namespace {

// In distances between the eyes, of the boxes: how wide they are, as HOG and cascade detectors put
// them around frontal faces, and how far below the eyes the middle of the first four is.
constexpr double kBoxWidth = 2.4, kBoxBelowEyes = 0.36;
constexpr double kBoxPixels = 290;
constexpr double kDark = 100;  // grey value of the brightest part of a view that is stretched

/// A grey value between the pixels of a picture, or a negative one outside of it.
float value_at(const ImageView& image, float u, float v) {
  if (!(u >= 0 && v >= 0 && u < static_cast<float>(image.width - 1) &&
        v < static_cast<float>(image.height - 1))) {
    return -1;
  }
  const auto i = static_cast<int>(u), j = static_cast<int>(v);
  const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
  const std::uint8_t* at = image.data + static_cast<std::size_t>(j) * image.stride + i;
  const std::uint8_t* below = at + image.stride;
  const float top = static_cast<float>(at[0]) + a * static_cast<float>(at[1] - at[0]);
  const float bottom = static_cast<float>(below[0]) + a * static_cast<float>(below[1] - below[0]);
  return top + b * (bottom - top);
}

}  // namespace

void FrontalView::render(const ImageView& left, const ImageView& right, const Alignment& alignment,
                         const Features& features, const StereoCamera& camera) {
  const DisparitySurface& surface = alignment.surface;
  const DisparitySurface plane = plane_through(
      features,
      {surface.at(features.left_eye), surface.at(features.right_eye), surface.at(features.mouth)});
  const Eigen::Vector3d into = -plane.plane_normal(camera);
  const Eigen::Vector3d eyes = plane.point(features.between_eyes(), camera);
  const Eigen::Vector3d to_right =
      plane.point(features.right_eye, camera) - plane.point(features.left_eye, camera);
  const double pixel = to_right.norm() * kBoxWidth / kBoxPixels;  // [m]
  const Eigen::Vector3d across = to_right.normalized() * pixel, down = into.cross(across);
  const double middle = 0.5 * (kSize - 1),
               eyes_row = middle - kBoxBelowEyes / kBoxWidth * kBoxPixels;
  Eigen::Matrix3d camera_G_view, intrinsics;
  camera_G_view << across, down, eyes - middle * across - eyes_row * down;
  intrinsics << camera.focal_px, 0, camera.cx, 0, camera.focal_px, camera.cy, 0, 0, 1;
  left_H_view_ = intrinsics * camera_G_view;

  pixels_.resize(std::size_t{kSize} * kSize);
  const Eigen::Matrix3f h = left_H_view_.cast<float>();
  const Eigen::Matrix<float, 6, 1> c = surface.c.cast<float>();
  const Eigen::Vector3f rows = alignment.rows.cast<float>();
  const auto gain = static_cast<float>(alignment.gain),
             offset = static_cast<float>(alignment.offset);
  const auto per_reach = static_cast<float>(1 / surface.reach);
  const Eigen::Vector2f from = surface.middle.cast<float>();
  std::uint8_t* to = pixels_.data();
  for (int j = 0; j < kSize; ++j) {
    Eigen::Vector3f p = h.col(1) * static_cast<float>(j) + h.col(2);
    for (int i = 0; i < kSize; ++i, ++to, p += h.col(0)) {
      const float u = p.x() / p.z(), v = p.y() / p.z();
      const float x = (u - from.x()) * per_reach, y = (v - from.y()) * per_reach;
      const float d = c[0] + c[1] * x + c[2] * y + x * (c[3] * x + c[4] * y) + c[5] * y * y;
      const float in_left = value_at(left, u, v);
      const float in_right = value_at(right, u - d, v + rows[0] + rows[1] * x + rows[2] * y);
      float value = in_left;
      if (in_right >= 0) {
        const float corrected = gain * in_right + offset;
        value = in_left < 0 ? corrected : 0.5f * (in_left + corrected);
      }
      *to = static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
    }
  }
}

ImageView FrontalView::image() {
  const ImageView as_seen{.data = pixels_.data(), .width = kSize, .height = kSize, .stride = kSize};
  return stretched_if_dark(as_seen, kDark, stretched_);
}

std::array<std::array<PixelBox, 4>, 2> FrontalView::face_boxes() const {
  constexpr double kShift = 0.06;  // of the box
  const auto box = [](double right, double down, double scale) {
    const double first = 0.5 * (kSize - 1 - kBoxPixels), step = kShift * kBoxPixels;
    return PixelBox{first + right * step, first + down * step, kBoxPixels, kBoxPixels}.scaled(
        scale);
  };
  const auto corners = [&](double lower) {
    return std::array{box(-1, lower - 1, 0.96), box(1, lower + 1, 1.04), box(1, lower - 1, 0.96),
                      box(-1, lower + 1, 1.04)};
  };
  return {corners(0), corners(1)};
}

double FrontalView::eye_distance() const { return kBoxPixels / kBoxWidth; }

}  // namespace armature::face_pose::surface
