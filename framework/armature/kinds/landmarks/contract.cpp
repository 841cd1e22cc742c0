// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/contract.hpp"

#include <cmath>
#include <limits>

namespace armature {

void LandmarkLaws::expect_same(const std::vector<Landmark>& a, const std::vector<Landmark>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].point, b[i].point);
    EXPECT_EQ(a[i].sigma, b[i].sigma);
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LandmarkLaws);

TEST_P(LandmarkLaws, FindsAsManyLandmarksAsItsSchemeHasNearTheBox) {
  const auto found = finder().find(face_.view(), box_);
  ASSERT_TRUE(found) << found.error().text;
  ASSERT_EQ(found->size(), landmark_count(finder().scheme()));
  for (const Landmark& landmark : *found) {
    ASSERT_TRUE(landmark.point.allFinite());
    EXPECT_GE(landmark.point.x(), box_.left - box_.width);
    EXPECT_GE(landmark.point.y(), box_.top - box_.height);
    EXPECT_LE(landmark.point.x(), box_.right() + box_.width);
    EXPECT_LE(landmark.point.y(), box_.bottom() + box_.height);
    EXPECT_GT(landmark.sigma, 0);
    EXPECT_TRUE(std::isfinite(landmark.sigma));
  }
}

TEST_P(LandmarkLaws, TellsLeftEyeRightEyeAndMouthOfAnUprightFaceApart) {
  FaceLandmarks face{.scheme = finder().scheme(), .points = {}, .box = box_};
  face.points = finder().find(face_.view(), box_).value();
  const auto at = [&](FaceFeature feature) { return face.feature(feature).point; };
  const double eyes = at(FaceFeature::right_eye).x() - at(FaceFeature::left_eye).x();
  EXPECT_GT(eyes, 0.2 * box_.width);
  EXPECT_GT(at(FaceFeature::mouth).y(), at(FaceFeature::left_eye).y() + 0.5 * eyes);
  EXPECT_GT(at(FaceFeature::mouth).y(), at(FaceFeature::right_eye).y() + 0.5 * eyes);
}

TEST_P(LandmarkLaws, EqualPicturesGiveEqualBitsWhateverWasSeenInBetween) {
  const auto first = finder().find(face_.view(), box_);
  static_cast<void>(finder().find(Picture::of_noise(1).view(), {10, 10, 100, 100}));
  const auto second = finder().find(face_.view(), box_);
  ASSERT_TRUE(first && second);
  expect_same(*first, *second);
}

TEST_P(LandmarkLaws, RowsMayBeLongerThanThePictureIsWide) {
  const Picture longer = face_.with_longer_rows(37);
  ImageView view = longer.view();
  view.width = face_.width;
  const auto found = finder().find(view, box_), same = finder().find(face_.view(), box_);
  ASSERT_TRUE(found && same);
  expect_same(*found, *same);
}

TEST_P(LandmarkLaws, ABoxThatLiesElsewhereIsAnsweredWithFiniteLandmarksOrARefusal) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<PixelBox> boxes{{-1e6, 0, 50, 50},  {1e6, 1e6, 50, 50}, {10, 10, 0, 0},
                                    {0, 0, 1e-3, 1e-3}, {0, 0, 1e9, 1e9},   {-50, 900, 1, 1},
                                    {0, 0, 1, 1e5},     {10, 10, -30, -30}, {kNan, 0, 50, 50},
                                    {0, 0, kNan, 50}};
  for (const PixelBox& box : boxes) {
    const auto found = finder().find(face_.view(), box);
    if (!found) {
      EXPECT_FALSE(found.error().text.empty());
      continue;
    }
    EXPECT_EQ(found->size(), landmark_count(finder().scheme()));
    for (const Landmark& landmark : *found) EXPECT_TRUE(landmark.point.allFinite());
  }
}

TEST_P(LandmarkLaws, RefusesViewsThatAreNoImage) {
  const auto refusal = [&](const ImageView& view) {
    const auto found = finder().find(view, box_);
    EXPECT_FALSE(found);
    return found ? std::string{} : found.error().text;
  };
  EXPECT_EQ(refusal({}), "empty image");
  ImageView flat = face_.view();
  flat.height = 0;
  EXPECT_EQ(refusal(flat), "empty image");
  ImageView overlapping = face_.view();
  overlapping.stride = 5;
  EXPECT_EQ(refusal(overlapping),
            "an image of " + std::to_string(face_.width) + " pixels in rows of 5");
}

}  // namespace armature
