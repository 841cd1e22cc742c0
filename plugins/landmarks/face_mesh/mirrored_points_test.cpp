// SPDX-License-Identifier: Apache-2.0
// Pairs of points of the two halves of the mesh.
#include "mirrored_points.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/landmarks/landmarks.hpp"

namespace armature::landmarks::face_mesh {
namespace {

TEST(MirroredPoints, MirroredTwiceIsThePointItself) {
  int in_the_middle = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    ASSERT_LT(kMirroredPoints[i], kPoints);
    EXPECT_EQ(kMirroredPoints[kMirroredPoints[i]], i);
    in_the_middle += kMirroredPoints[i] == i;
  }
  EXPECT_EQ(in_the_middle, 28);
}

TEST(MirroredPoints, TheLeftEyesPointsAreTheRightEyes) {
  const auto of = [](FaceFeature feature) {
    const auto around = landmarks_around(feature, LandmarkScheme::mesh468);
    return std::vector(around.begin(), around.end());
  };
  std::vector<std::size_t> mirrored;
  for (const std::size_t i : of(FaceFeature::left_eye)) mirrored.push_back(kMirroredPoints[i]);
  std::vector<std::size_t> right = of(FaceFeature::right_eye), mouth = of(FaceFeature::mouth);
  std::ranges::sort(mirrored);
  std::ranges::sort(right);
  EXPECT_EQ(mirrored, right);
  for (std::size_t i : mouth) {
    EXPECT_NE(std::ranges::find(mouth, kMirroredPoints[i]), mouth.end()) << "point " << i;
  }
}

}  // namespace
}  // namespace armature::landmarks::face_mesh
