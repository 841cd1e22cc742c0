// SPDX-License-Identifier: Apache-2.0
// A drawn face has its features where it says; faces of other seeds look different.
#include "armature/scene/generated_face.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>

#include "armature/scene/face_traits.hpp"

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

TEST(FaceTraits, OfSeed1AreTheUsualOnes) {
  const FaceTraits traits = traits_of(1);
  EXPECT_EQ(traits.eyes_to_mouth_mm, 65);
  EXPECT_EQ(traits.width, 1);
  EXPECT_EQ(traits.skin, 0);
  EXPECT_FALSE(traits.is_bald || traits.has_glasses || traits.has_beard);
}

TEST(FaceTraits, OfFiftySeedsDifferAndSomeWearGlassesSomeABeard) {
  std::set<double> proportions, widths;
  int with_glasses = 0, with_beard = 0, bald = 0;
  for (std::uint64_t seed = 2; seed < 52; ++seed) {
    const FaceTraits traits = traits_of(seed);
    EXPECT_EQ(traits.eyes_to_mouth_mm, traits_of(seed).eyes_to_mouth_mm);
    EXPECT_GE(traits.eyes_to_mouth_mm, 59);
    EXPECT_LE(traits.eyes_to_mouth_mm, 71);
    proportions.insert(traits.eyes_to_mouth_mm);
    widths.insert(traits.width);
    with_glasses += traits.has_glasses;
    with_beard += traits.has_beard;
    bald += traits.is_bald;
  }
  EXPECT_EQ(proportions.size(), 50U);
  EXPECT_EQ(widths.size(), 50U);
  for (const int some : {with_glasses, with_beard, bald}) {
    EXPECT_GT(some, 4);
    EXPECT_LT(some, 30);
  }
}

TEST(GeneratedFace, HasItsMouthWhereItsTraitsSay) {
  for (const std::uint64_t seed : {1, 4, 9, 20}) {
    SCOPED_TRACE(seed);
    const Photo photo = generated_face(seed, 0.063);
    const double down = (photo.mouth - 0.5 * (photo.left_eye + photo.right_eye)).y();
    EXPECT_NEAR(down * photo.m_per_px * 1e3, traits_of(seed).eyes_to_mouth_mm, 1e-9);
    // The line between the lips is the darkest thing around.
    const auto u = static_cast<int>(std::lround(photo.mouth.x()));
    const auto v = static_cast<int>(std::lround(photo.mouth.y()));
    EXPECT_LT(photo.image.at(u, v), photo.image.at(u, v - 8) - 20);
    EXPECT_LT(photo.image.at(u, v), photo.image.at(u, v + 10) - 20);
  }
}

}  // namespace
}  // namespace armature::scene
