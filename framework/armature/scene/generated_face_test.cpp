// SPDX-License-Identifier: Apache-2.0
// A drawn face has its features where it says, and follows its seed.
#include "armature/scene/generated_face.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::scene {
namespace {

TEST(GeneratedFace, HasItsEyesAsFarApartAsAsked) {
  for (const double distance : {0.063, 0.104}) {
    const Photo photo = generated_face(1, distance);
    EXPECT_NEAR((photo.right_eye - photo.left_eye).norm() * photo.m_per_px, distance, 1e-9);
    // Pupils are dark, their surroundings are not.
    for (const Eigen::Vector2d& eye : {photo.left_eye, photo.right_eye}) {
      const auto u = static_cast<int>(std::lround(eye.x())),
                 v = static_cast<int>(std::lround(eye.y()));
      EXPECT_LT(photo.image.at(u, v), 50);
      EXPECT_GT(photo.image.at(u + 20, v), 120);
    }
  }
}

TEST(GeneratedFace, FollowsItsSeed) {
  const Photo a = generated_face(1, 0.063);
  EXPECT_EQ(a.image.pixels, generated_face(1, 0.063).image.pixels);
  EXPECT_NE(a.image.pixels, generated_face(2, 0.063).image.pixels);
}

}  // namespace
}  // namespace armature::scene
