// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/detector/contract.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace armature {

SearchRegion DetectorLaws::everywhere(const ImageView& view) {
  return {.box = {0, 0, view.width - 1.0, view.height - 1.0}, .face_width = {}};
}

DetectedFace DetectorLaws::only_face() const {
  const auto faces = detector().detect(face_.view(), everywhere(face_.view()));
  EXPECT_TRUE(faces) << faces.error().text;
  EXPECT_EQ(faces->size(), 1u);
  return faces->at(0);
}

bool DetectorLaws::holds_middle(const PixelBox& box) const {
  const double x = GetParam().middle_x, y = GetParam().middle_y;
  return box.left < x && x < box.right() && box.top < y && y < box.bottom();
}

void DetectorLaws::expect_same(const std::vector<DetectedFace>& a,
                               const std::vector<DetectedFace>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].score, b[i].score);
    EXPECT_EQ(a[i].box.left, b[i].box.left);
    EXPECT_EQ(a[i].box.top, b[i].box.top);
    EXPECT_EQ(a[i].box.width, b[i].box.width);
    EXPECT_EQ(a[i].box.height, b[i].box.height);
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DetectorLaws);

TEST_P(DetectorLaws, FindsTheFaceWhereItIs) {
  const DetectedFace face = only_face();
  EXPECT_TRUE(holds_middle(face.box));
  EXPECT_TRUE(std::isfinite(face.score));
  EXPECT_LT(face.box.width, face_.width);
}

TEST_P(DetectorLaws, FindsItAgainInARegionAroundItAndNotInOneAside) {
  const PixelBox box = only_face().box;
  const auto found =
      detector().detect(face_.view(), {.box = box.scaled(2), .face_width = box.width});
  ASSERT_TRUE(found) << found.error().text;
  ASSERT_EQ(found->size(), 1u);
  EXPECT_TRUE(holds_middle(found->front().box));
  EXPECT_NEAR(found->front().box.width / box.width, 1, 0.3);
  const PixelBox aside{0, 0, box.left, face_.height - 1.0};
  const auto none = detector().detect(face_.view(), {.box = aside, .face_width = box.width});
  ASSERT_TRUE(none) << none.error().text;
  EXPECT_TRUE(none->empty());
}

TEST_P(DetectorLaws, APictureWithoutAFaceHasNone) {
  for (const int grey : {0, 1, 128, 255}) {
    SCOPED_TRACE(grey);
    const Picture wall = Picture::of_one_grey(static_cast<std::uint8_t>(grey));
    const auto faces = detector().detect(wall.view(), everywhere(wall.view()));
    ASSERT_TRUE(faces) << faces.error().text;
    EXPECT_TRUE(faces->empty());
  }
  for (const std::uint64_t seed : {5u, 6u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Picture noise = Picture::of_noise(seed);
    const auto faces = detector().detect(noise.view(), everywhere(noise.view()));
    ASSERT_TRUE(faces) << faces.error().text;
    EXPECT_TRUE(faces->empty());
  }
}

TEST_P(DetectorLaws, PicturesTooSmallForAFaceHaveNone) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 3}, {1, 400}, {400, 1}, {79, 79}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const Picture small = Picture::of_one_grey(100, width, height);
    const auto faces = detector().detect(small.view(), everywhere(small.view()));
    ASSERT_TRUE(faces) << faces.error().text;
    EXPECT_TRUE(faces->empty());
  }
}

TEST_P(DetectorLaws, EqualPicturesGiveEqualBitsWhateverWasSeenInBetween) {
  const auto first = detector().detect(face_.view(), everywhere(face_.view()));
  const Picture noise = Picture::of_noise(1);
  static_cast<void>(detector().detect(noise.view(), everywhere(noise.view())));
  const auto second = detector().detect(face_.view(), everywhere(face_.view()));
  ASSERT_TRUE(first && second);
  expect_same(*first, *second);
}

TEST_P(DetectorLaws, RowsMayBeLongerThanThePictureIsWide) {
  const Picture longer = face_.with_longer_rows(37);
  ImageView view = longer.view();
  view.width = face_.width;
  const auto found = detector().detect(view, everywhere(view));
  const auto same = detector().detect(face_.view(), everywhere(face_.view()));
  ASSERT_TRUE(found && same);
  expect_same(*found, *same);
}

TEST_P(DetectorLaws, ARegionThatIsNoneHasNoFaces) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<PixelBox> boxes{{-1e6, 0, 50, 50},  {1e6, 1e6, 50, 50}, {10, 10, 0, 0},
                                    {0, 0, 1e-3, 1e-3}, {-50, 9000, 1, 1},  {10, 10, -30, -30},
                                    {kNan, 0, 50, 50},  {0, 0, kNan, 50}};
  for (const PixelBox& box : boxes) {
    for (const std::optional<double> width : {std::optional<double>{}, {100.0}, {0.0}, {kNan}}) {
      const auto faces = detector().detect(face_.view(), {.box = box, .face_width = width});
      ASSERT_TRUE(faces) << faces.error().text;
      EXPECT_TRUE(faces->empty());
    }
  }
}

TEST_P(DetectorLaws, RefusesViewsThatAreNoImage) {
  const auto refusal = [&](const ImageView& view) {
    const auto faces = detector().detect(view, everywhere(view));
    EXPECT_FALSE(faces);
    return faces ? std::string{} : faces.error().text;
  };
  EXPECT_EQ(refusal({}), "empty image");
  ImageView overlapping = face_.view();
  overlapping.stride = 5;
  EXPECT_EQ(refusal(overlapping),
            "an image of " + std::to_string(face_.width) + " pixels in rows of 5");
}

}  // namespace armature
