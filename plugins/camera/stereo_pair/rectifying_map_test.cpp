// SPDX-License-Identifier: Apache-2.0
#include "rectifying_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/robot/geometry/rotation.hpp"

namespace armature::camera::stereo_pair {
namespace {

/// The world's brightness in a direction: waves of some 100 px.
double brightness(const Eigen::Vector3d& direction) {
  const Eigen::Vector2d ray = direction.hnormalized();
  return 128 + 50 * std::sin(20 * ray.x()) + 50 * std::cos(25 * ray.y() + 5 * ray.x());
}

TEST(RectifyingMap, ShowsTheWorldAsAPinholeCameraThatIsTurnedWould) {
  const stereo::Lens lens{
      .fx = 300, .fy = 304, .cx = 162, .cy = 118, .distortion = {-0.2, 0.05, 0.001, -0.002, 0.003}};
  const StereoCamera camera{.width = 320, .height = 240, .focal_px = 310, .cx = 155, .cy = 121};
  const Eigen::Matrix3d rectified_R_camera = rotation_from_rpy({0.03, -0.05, 0.04});
  std::vector<std::uint8_t> raw(320 * 240);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const auto ray = lens.ray_of({u, v});
      ASSERT_TRUE(ray);
      raw[static_cast<std::size_t>(v * 320 + u)] = static_cast<std::uint8_t>(
          std::lround(brightness(rectified_R_camera * ray->homogeneous())));
    }
  }
  const RectifyingMap map{camera, rectified_R_camera, lens};
  std::vector<std::uint8_t> rectified;
  map.rectify({.data = raw.data(), .width = 320, .height = 240, .stride = 320}, rectified);
  ASSERT_EQ(rectified.size(), raw.size());
  int seen = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const auto from =
          stereo::raw_pixel(camera, rectified_R_camera, lens, 10, Eigen::Vector2d{u, v});
      const int grey = rectified[static_cast<std::size_t>(v * 320 + u)];
      if (from && from->x() >= 0 && from->y() >= 0 && from->x() <= 319 && from->y() <= 239) {
        ++seen;
        const double expected = brightness({(u - 155) / 310.0, (v - 121) / 310.0, 1});
        ASSERT_NEAR(grey, expected, 1.5) << u << ", " << v << ": rounded twice";
      } else if (!from || from->x() < -1 || from->y() < -1 || from->x() > 320 || from->y() > 240) {
        ASSERT_EQ(grey, 0) << "what is not seen is black";
      }
    }
  }
  EXPECT_GT(seen, 60'000);
  EXPECT_NEAR(map.coverage(), seen / (320.0 * 240), 0.01) << "the rim of a pixel counts, too";
}

TEST(RectifyingMap, OfAStraightCameraChangesNoByte) {
  const stereo::Lens lens{.fx = 300, .fy = 300, .cx = 159.5, .cy = 119.5};
  const StereoCamera camera{.width = 320, .height = 240, .focal_px = 300, .cx = 159.5, .cy = 119.5};
  std::vector<std::uint8_t> raw(330 * 240), rectified, expected;
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<std::uint8_t>(i * 31 + i / 330);
  for (std::size_t v = 0; v < 240; ++v) {
    const auto row = raw.begin() + static_cast<std::ptrdiff_t>(330 * v);
    expected.insert(expected.end(), row, row + 320);
  }
  const RectifyingMap map{camera, Eigen::Matrix3d::Identity(), lens};
  map.rectify({.data = raw.data(), .width = 320, .height = 240, .stride = 330}, rectified);
  EXPECT_EQ(rectified, expected);
  EXPECT_EQ(map.coverage(), 1);
}

TEST(RectifyingMap, DoesNotShowWhatABentLensWouldShowTwice) {
  // r - 0.4 r^3 turns back at r = 0.91: what lies farther out would come from inside again.
  const stereo::Lens lens{.fx = 100, .fy = 100, .cx = 159.5, .cy = 119.5, .distortion = {-0.4}};
  const StereoCamera camera{.width = 320, .height = 240, .focal_px = 100, .cx = 159.5, .cy = 119.5};
  const std::vector<std::uint8_t> raw(320 * 240, 200);
  std::vector<std::uint8_t> rectified;
  const RectifyingMap map{camera, Eigen::Matrix3d::Identity(), lens};
  map.rectify({.data = raw.data(), .width = 320, .height = 240, .stride = 320}, rectified);
  EXPECT_EQ(rectified[120 * 320 + 160], 200);
  EXPECT_EQ(rectified[120 * 320 + 245], 200);
  EXPECT_EQ(rectified[120 * 320 + 255], 0);
}

}  // namespace
}  // namespace armature::camera::stereo_pair
