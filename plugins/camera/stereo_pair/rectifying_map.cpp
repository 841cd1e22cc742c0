// SPDX-License-Identifier: Apache-2.0
#include "rectifying_map.hpp"

#include <opencv2/imgproc.hpp>

namespace armature::camera::stereo_pair {

RectifyingMap::RectifyingMap(const StereoCamera& rectified,
                             const Eigen::Matrix3d& rectified_R_camera, const stereo::Lens& lens) {
  constexpr float kOutside = -10;
  const int width = rectified.width, height = rectified.height;
  const double max_radius = lens.max_radius();
  // In braces these numbers would be a matrix' content.
  cv::Mat columns(height, width, CV_32FC1), rows(height, width, CV_32FC1);
  double seen = 0;
  for (int v = 0; v < height; ++v) {
    auto* column = columns.ptr<float>(v);
    auto* row = rows.ptr<float>(v);
    for (int u = 0; u < width; ++u) {
      const auto pixel =
          stereo::raw_pixel(rectified, rectified_R_camera, lens, max_radius, Eigen::Vector2d{u, v});
      const bool inside =
          pixel && pixel->x() > -1 && pixel->y() > -1 && pixel->x() < width && pixel->y() < height;
      column[u] = inside ? static_cast<float>(pixel->x()) : kOutside;
      row[u] = inside ? static_cast<float>(pixel->y()) : kOutside;
      seen += inside;
    }
  }
  coverage_ = seen / static_cast<double>(columns.total());
  cv::convertMaps(columns, rows, pixels_, fractions_, CV_16SC2);
}

void RectifyingMap::rectify(const ImageView& raw, std::vector<std::uint8_t>& pixels) const {
  const cv::Mat from{raw.height, raw.width, CV_8UC1, const_cast<std::uint8_t*>(raw.data),
                     raw.stride};
  pixels.resize(pixels_.total());
  cv::Mat to{pixels_.rows, pixels_.cols, CV_8UC1, pixels.data()};
  cv::remap(from, to, pixels_, fractions_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
}

}  // namespace armature::camera::stereo_pair
