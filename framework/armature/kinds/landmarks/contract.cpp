// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/contract.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace armature {

Expected<StereoLandmarks> LandmarkLaws::find(const StereoPicture& picture, State& state) const {
  return finder().find(picture.left_view(), picture.right_view(), state);
}

StereoPicture LandmarkLaws::of_one_colour(std::uint8_t grey, int width, int height) {
  const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height), grey);
  return {width, height, pixels, pixels};
}

StereoPicture LandmarkLaws::noise(std::uint64_t seed) {
  StereoPicture picture = of_one_colour(0);
  std::mt19937_64 random{seed};
  for (auto* pixels : {&picture.left, &picture.right}) {
    for (auto& pixel : *pixels) pixel = static_cast<std::uint8_t>(random());
  }
  return picture;
}

void LandmarkLaws::expect_no_face(const StereoPicture& picture) const {
  State state = after_a_face();
  const auto found = find(picture, state);
  ASSERT_FALSE(found);
  EXPECT_FALSE(found.error().text.empty());
  EXPECT_FALSE(state.left || state.right) << "what was lost is forgotten";
}

LandmarkLaws::State LandmarkLaws::after_a_face() const {
  State state;
  EXPECT_TRUE(find(face_, state));
  return state;
}

void LandmarkLaws::expect_same(const FaceLandmarks& a, const FaceLandmarks& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.mean_intensity, b.mean_intensity);
  expect_same(a.box, b.box);
}

void LandmarkLaws::expect_same(const std::optional<PixelBox>& a, const std::optional<PixelBox>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->left, b->left);
  EXPECT_EQ(a->top, b->top);
  EXPECT_EQ(a->width, b->width);
  EXPECT_EQ(a->height, b->height);
}

void LandmarkLaws::expect_in_picture(const FaceLandmarks& face) const {
  const PixelBox& box = face.box;
  EXPECT_GT(box.width, 0);
  EXPECT_GT(box.height, 0);
  EXPECT_TRUE(std::isfinite(face.score));
  // A face at the edge may reach beyond it, but not by more than its own size.
  EXPECT_GE(box.left, -box.width);
  EXPECT_GE(box.top, -box.height);
  EXPECT_LE(box.left + box.width, face_.width + box.width);
  EXPECT_LE(box.top + box.height, face_.height + box.height);
  for (const Eigen::Vector2d& point : face.points) {
    ASSERT_TRUE(point.allFinite());
    EXPECT_GE(point.x(), box.left - box.width);
    EXPECT_GE(point.y(), box.top - box.height);
    EXPECT_LE(point.x(), box.left + 2 * box.width);
    EXPECT_LE(point.y(), box.top + 2 * box.height);
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LandmarkLaws);

TEST_P(LandmarkLaws, FindsAFaceNearItsBoxInBothPicturesAndRemembersWhere) {
  State state;
  const auto found = find(face_, state);
  ASSERT_TRUE(found) << found.error().text;
  expect_in_picture(found->left);
  expect_in_picture(found->right);
  EXPECT_GE(found->left.mean_intensity, 0);
  EXPECT_LE(found->left.mean_intensity, 255);
  EXPECT_TRUE(state.left && state.right);
  // A rectified pair: the same rows, further left in the right image.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
    sum += found->left.points[i] - found->right.points[i];
  }
  const Eigen::Vector2d disparity = sum / FaceLandmarks::kCount;
  EXPECT_GT(disparity.x(), 0);
  EXPECT_LT(std::abs(disparity.y()), 0.1 * found->left.box.height);
}

TEST_P(LandmarkLaws, EqualPicturesAndStatesGiveEqualBitsWhateverWasSeenInBetween) {
  for (const State& from : {State{}, after_a_face()}) {
    State first_state = from, second_state = from, other = from;
    const auto first = find(face_, first_state);
    static_cast<void>(find(noise(1), other));
    const auto second = find(face_, second_state);
    ASSERT_TRUE(first && second);
    expect_same(first->left, second->left);
    expect_same(first->right, second->right);
    expect_same(first_state.left, second_state.left);
    expect_same(first_state.right, second_state.right);
  }
}

TEST_P(LandmarkLaws, SaysThatThereIsNoFaceAndForgetsWhereItWas) {
  for (const int grey : {0, 1, 128, 255}) {
    SCOPED_TRACE(grey);
    expect_no_face(of_one_colour(static_cast<std::uint8_t>(grey), face_.width, face_.height));
    expect_no_face(of_one_colour(static_cast<std::uint8_t>(grey)));
  }
  for (const std::uint64_t seed : {5u, 6u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_no_face(noise(seed));
  }
}

TEST_P(LandmarkLaws, AFaceInOnlyOneOfThePicturesIsNone) {
  const StereoPicture wall = of_one_colour(120, face_.width, face_.height);
  for (const bool left : {true, false}) {
    State state;
    const auto found = finder().find(left ? face_.left_view() : wall.left_view(),
                                     left ? wall.right_view() : face_.right_view(), state);
    ASSERT_FALSE(found);
    EXPECT_FALSE(found.error().text.empty());
    EXPECT_FALSE(state.right);
  }
}

TEST_P(LandmarkLaws, PicturesTooSmallForAFaceHaveNone) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 3}, {1, 400}, {400, 1}, {79, 79}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    expect_no_face(of_one_colour(100, width, height));
  }
}

TEST_P(LandmarkLaws, AStateFromElsewhereIsNoHarm) {
  const std::vector<PixelBox> boxes{{-1e6, 0, 50, 50},  {1e6, 1e6, 50, 50}, {10, 10, 0, 0},
                                    {0, 0, 1e-3, 1e-3}, {0, 0, 1e5, 1e5},   {-50, 900, 1, 1}};
  for (const PixelBox& box : boxes) {
    State state{.left = box, .right = box};
    const auto found = find(face_, state);
    ASSERT_TRUE(found) << found.error().text;
    expect_in_picture(found->left);
    State lost{.left = box, .right = box};
    EXPECT_FALSE(find(of_one_colour(90), lost));
  }
}

TEST_P(LandmarkLaws, RowsMayBeLongerThanThePictureIsWide) {
  constexpr int kMore = 37;
  StereoPicture wide{face_.width, face_.height, {}, {}};
  for (const auto& [from, to] : {std::pair{&face_.left, &wide.left}, {&face_.right, &wide.right}}) {
    for (int v = 0; v < face_.height; ++v) {
      const auto row = from->begin() + std::ptrdiff_t{v} * face_.width;
      to->insert(to->end(), row, row + face_.width);
      to->insert(to->end(), kMore, 255);
    }
  }
  ImageView left = wide.left_view(), right = wide.right_view();
  left.stride = right.stride = static_cast<std::size_t>(face_.width + kMore);
  State state, same_state;
  const auto found = finder().find(left, right, state);
  const auto same = find(face_, same_state);
  ASSERT_TRUE(found && same);
  expect_same(found->left, same->left);
  expect_same(found->right, same->right);
}

TEST_P(LandmarkLaws, RefusesViewsThatAreNoPair) {
  const ImageView good = face_.left_view();
  const auto refusal = [&](const ImageView& left, const ImageView& right) {
    State state;
    const auto found = finder().find(left, right, state);
    EXPECT_FALSE(found);
    return found ? std::string{} : found.error().text;
  };
  EXPECT_EQ(refusal({}, {}), "empty image");
  EXPECT_EQ(refusal(good, {}), "empty image");
  ImageView flat = good;
  flat.height = 0;
  EXPECT_EQ(refusal(flat, flat), "empty image");
  ImageView overlapping = good;
  overlapping.stride = 5;
  EXPECT_EQ(refusal(good, overlapping),
            "an image of " + std::to_string(good.width) + " pixels in rows of 5");
  ImageView lower = good;
  lower.height = good.height - 1;
  const std::string width = std::to_string(good.width) + " x ";
  EXPECT_EQ(refusal(good, lower), "the left image is " + width + std::to_string(good.height) +
                                      " pixels, the right one " + width +
                                      std::to_string(good.height - 1));
}
}  // namespace armature
