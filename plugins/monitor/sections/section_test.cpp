// SPDX-License-Identifier: Apache-2.0
#include "section.hpp"

#include <gtest/gtest.h>

namespace armature::monitor::sections {
namespace {

using Eigen::Vector3d;

VolumeGeometry cube() {
  VolumeGeometry geometry{.size = {101, 101, 101}};
  geometry.origin = {-0.05, -0.05, -0.03};
  return geometry;
}

Section through(View view, const Vector3d& point) {
  return section_through(view, point, cube(), 0.1, 200);
}

TEST(Sections, GoThroughTheirPointAndAreAboutTheMiddleOfTheVolume) {
  const Vector3d point{0.01, -0.02, 0.035};
  for (const View view : {View::axial, View::coronal, View::sagittal}) {
    EXPECT_NEAR(through(view, point).seen(point).z(), 0, 1e-15);
  }
  EXPECT_LT((through(View::axial, point).point_at(99.5, 99.5) - Vector3d{0, 0, 0.035}).norm(),
            1e-12);
  EXPECT_LT((through(View::coronal, point).point_at(99.5, 99.5) - Vector3d{0, -0.02, 0.02}).norm(),
            1e-12);
}

TEST(Sections, SeeAPointWhereItIs) {
  const Section section = through(View::sagittal, {0.01, 0, 0});
  const Vector3d seen = section.seen(section.point_at(12, 34) + Vector3d{0.003, 0, 0});
  EXPECT_NEAR(seen.x(), 12, 1e-9);
  EXPECT_NEAR(seen.y(), 34, 1e-9);
  EXPECT_NEAR(std::abs(seen.z()), 0.003, 1e-12);
}

TEST(Sections, ShowThePatientAsRadiologistsLookAtHim) {
  const Vector3d middle{0, 0, 0.02}, left{0.02, 0, 0.02}, back{0, 0.02, 0.02}, head{0, 0, 0.04};
  EXPECT_GT(through(View::axial, middle).seen(left).x(), 100);
  EXPECT_GT(through(View::axial, middle).seen(back).y(), 100);
  EXPECT_GT(through(View::coronal, middle).seen(left).x(), 100);
  EXPECT_LT(through(View::coronal, middle).seen(head).y(), 99);
  EXPECT_GT(through(View::sagittal, middle).seen(back).x(), 100);
  EXPECT_LT(through(View::sagittal, middle).seen(head).y(), 99);
}

TEST(Sections, AreBlackBelowTheirWindowAndWhiteAboveIt) {
  Volume volume{cube(), std::vector<std::int16_t>(cube().count(), 0)};
  for (int i = 0; i < 101; ++i) {
    for (int j = 0; j < 101; ++j) {
      for (int k = 0; k < 101; ++k) {
        volume.voxels[volume.offset(i, j, k)] = static_cast<std::int16_t>(10 * i - 500);
      }
    }
  }
  const Section section = through(View::axial, {0, 0, 0.02});
  const auto values = grey_values(volume, section, -100, 100);
  const auto value = [&](int u) { return values[static_cast<std::size_t>(200 * 100 + u)]; };
  EXPECT_EQ(value(10), 0);
  EXPECT_NEAR(value(100), 128 + 3, 2);  // 0.25 mm right of the middle
  EXPECT_EQ(value(190), 255);
}

}  // namespace
}  // namespace armature::monitor::sections
