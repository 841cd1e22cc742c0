// SPDX-License-Identifier: Apache-2.0
#include "drawing.hpp"

#include <gtest/gtest.h>

namespace armature::monitor::sections {
namespace {

using Eigen::Vector3d;

/// Water, everywhere.
Volume water() {
  VolumeGeometry geometry{.size = {51, 51, 51}, .spacing = Vector3d::Constant(0.002)};
  geometry.origin = Vector3d::Constant(-0.05);
  return {geometry, std::vector<std::int16_t>(geometry.count(), 0)};
}

Section axial(double z) {
  return section_through(View::axial, {0, 0, z}, water().geometry, 0.1, 200);
}

cv::Mat picture(double z, const Overlay& overlay) {
  return drawn(water(), axial(z), -100, 100, overlay, "axial");
}

/// Pixels about a point that are not grey.
int coloured_about(const cv::Mat& picture, const Vector3d& seen, int reach) {
  int count = 0;
  for (int v = static_cast<int>(seen.y()) - reach; v <= seen.y() + reach; ++v) {
    for (int u = static_cast<int>(seen.x()) - reach; u <= seen.x() + reach; ++u) {
      const auto pixel = picture.at<cv::Vec3b>(v, u);
      if (pixel[0] != pixel[1] || pixel[1] != pixel[2]) ++count;
    }
  }
  return count;
}

TEST(Drawings, OutlineAVesselWhereThePlaneCutsItAndNowhereElse) {
  Overlay overlay;
  overlay.vessels = {{"vessel 1", {0.01, 0, -0.02}, {0.01, 0, 0.02}, 0.004}};
  const Vector3d seen = axial(0).seen({0.01, 0, 0});
  EXPECT_GT(coloured_about(picture(0, overlay), seen, 9), 30);
  EXPECT_EQ(coloured_about(picture(0, overlay), seen, 4), 0);  // its inside stays what it is
  EXPECT_EQ(coloured_about(picture(0.03, overlay), seen, 9), 0);
}

TEST(Drawings, MarkWhereThePlanMeetsThePlane) {
  Overlay overlay;
  overlay.plan = {{0.02, 0, 0.04}, {0, 0, -0.02}};
  EXPECT_GT(coloured_about(picture(0.01, overlay), axial(0.01).seen({0.01, 0, 0.01}), 5), 15);
  EXPECT_GT(coloured_about(picture(-0.02, overlay), axial(-0.02).seen({0, 0, -0.02}), 3), 20);
}

TEST(Drawings, ShowTheNeedleFromItsTipOn) {
  Overlay overlay;
  overlay.needle = {{0, 0, 0}, {0.03, 0, 0}};
  const cv::Mat with = picture(0, overlay);
  EXPECT_GT(coloured_about(with, axial(0).seen({0, 0, 0}), 4), 20);
  EXPECT_GT(coloured_about(with, axial(0).seen({0.02, 0, 0}), 2), 5);
  EXPECT_EQ(coloured_about(with, axial(0).seen({-0.02, 0, 0}), 4), 0);
}

TEST(Drawings, OfThingsFarOutsideStayInTheirPicture) {
  Overlay overlay;
  overlay.plan = {{5, 5, 5}, {-1e9, 0, 0}};
  overlay.needle = {{1e6, 0, 0}, {0, 0, 0}};
  overlay.texts = {"to the target 1.0 mm", "to a vessel 2.0 mm"};
  EXPECT_EQ(picture(0, overlay).size(), cv::Size(200, 200));
}

}  // namespace
}  // namespace armature::monitor::sections
