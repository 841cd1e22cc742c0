// SPDX-License-Identifier: Apache-2.0
// A face in a stereo pair: 1. it is sought where it was last, then everywhere, 2. of several faces
// it keeps to the one it has, 3. the right picture is searched in the rows of the left one, 4. dark
// pictures are stretched and their brightness is told as it was, 5. what is missing is said, and
// where the pictures may be exchanged.
#include "armature/kinds/landmarks/stereo_face_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "armature/kinds/face_picture.hpp"

namespace armature {
namespace {

/// Sees faces where the test has put them: wherever their centre lies in the region.
class PlacedFaces final : public FaceDetector {
 public:
  Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                             const SearchRegion& region) override {
    searched.push_back(region);
    brightest = *std::max_element(image.data, image.data + image.stride * 2);
    std::vector<DetectedFace> found;
    for (const DetectedFace& face : image.data[0] == kLeft ? left : right) {
      const double x = face.box.left + face.box.width / 2, y = face.box.top + face.box.height / 2;
      if (x >= region.box.left && x <= region.box.right() && y >= region.box.top &&
          y <= region.box.bottom()) {
        found.push_back(face);
      }
    }
    return found;
  }
  static constexpr std::uint8_t kLeft = 0;  // the first pixel of the left picture
  std::vector<DetectedFace> left, right;
  std::vector<SearchRegion> searched;
  int brightest = 0;
};

/// The corners and the middle of the box.
class BoxCorners final : public LandmarkFinder {
 public:
  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView&, const PixelBox& box) override {
    PixelBox b = box.scaled(larger);
    b.left += aside;
    std::vector<Landmark> points;
    for (const Eigen::Vector2d& p : {Eigen::Vector2d{b.left, b.top},
                                     {b.right(), b.top},
                                     {b.left + b.width / 2, b.top},
                                     {b.left, b.bottom()},
                                     {b.right(), b.bottom()}}) {
      points.push_back({.point = p, .sigma = 0.5});
    }
    if (std::ranges::find(lower_mouth_at, box.left) != lower_mouth_at.end()) {
      for (Landmark& mouth : std::span{points}.last(2)) mouth.point.y() += 9;
    }
    if (is_short) points.pop_back();
    return points;
  }
  bool is_short = false;
  std::vector<double> lower_mouth_at;  // [px] left borders of boxes
  double aside = 0, larger = 1;        // [px]; of the box
};

class StereoFaceFinderTest : public ::testing::Test {
 protected:
  /// 400 x 300 pixels of one grey; the first pixel tells the pictures apart.
  static Picture picture(std::uint8_t first, std::uint8_t grey = 120) {
    Picture all = Picture::of_one_grey(grey, 400, 300);
    all.pixels[0] = first;
    return all;
  }
  Expected<StereoLandmarks> find() {
    detector_.searched.clear();
    return finder_.find(left_.view(), right_.view(), state_);
  }
  static DetectedFace face(double left, double top, double width, double score = 1) {
    return {.box = {left, top, width, width}, .score = score};
  }

  Picture left_ = picture(PlacedFaces::kLeft), right_ = picture(1);
  PlacedFaces detector_;
  BoxCorners corners_;
  StereoFaceFinder finder_{detector_, corners_, {.stretch_below = 100}};
  StereoFaceFinder::State state_;
};

TEST_F(StereoFaceFinderTest, TellsTheFaceOfBothPicturesWithItsLandmarks) {
  detector_.left = {face(200, 100, 80, 1.5)};
  detector_.right = {face(150, 101, 80)};
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.scheme, LandmarkScheme::five);
  EXPECT_EQ(found->left.box.left, 200);
  EXPECT_EQ(found->right.box.left, 150);
  EXPECT_EQ(found->left.score, 1.5);
  EXPECT_EQ(found->left.mean_intensity, 120);
  EXPECT_EQ(found->left.feature(FaceFeature::mouth).point, (Eigen::Vector2d{240, 180}));
  EXPECT_EQ(found->right.feature(FaceFeature::left_eye).point, (Eigen::Vector2d{150, 101}));
  EXPECT_EQ(found->right.feature(FaceFeature::left_eye).sigma, 0.5);
}

TEST_F(StereoFaceFinderTest, LooksWhereTheFaceWasAndThenEverywhere) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  ASSERT_TRUE(find());
  EXPECT_EQ(detector_.searched[0].box.width, 399);
  EXPECT_FALSE(detector_.searched[0].face_width);
  ASSERT_TRUE(find());
  ASSERT_EQ(detector_.searched.size(), 2u);
  EXPECT_EQ(detector_.searched[0].box.left, 160);
  EXPECT_EQ(detector_.searched[0].box.width, 160);
  EXPECT_EQ(detector_.searched[0].face_width, 80);
  EXPECT_EQ(detector_.searched[1].box.left, 110);
  detector_.left = {face(20, 10, 60)};
  detector_.right = {face(2, 10, 60)};
  EXPECT_FALSE(find());
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 20);
  EXPECT_EQ(detector_.searched[1].box.width, 399);
}

TEST_F(StereoFaceFinderTest, APairThatMissesTheFaceLeavesItForNoOtherOne) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  ASSERT_TRUE(find());
  const DetectedFace aside_left = face(20, 100, 90), aside_right = face(1, 100, 90);
  for (const bool sees_other : {true, false}) {
    detector_.left.clear();
    if (sees_other) detector_.left = {aside_left};
    detector_.right = {aside_right, face(150, 100, 80)};
    EXPECT_EQ(find().error().text, sees_other ? "the face is not in the left image, another one is"
                                              : "no face in the left image");
    detector_.left = {aside_left, face(205, 100, 80)};
    const auto found = find();
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_EQ(found->left.box.left, 205);
    EXPECT_EQ(found->right.box.left, 150);
  }
}

TEST_F(StereoFaceFinderTest, TakesTheLargestFaceAndKeepsToItWhateverTheScores) {
  detector_.left = {face(60, 100, 50, 9), face(200, 100, 80, 1)};
  detector_.right = {face(30, 100, 50, 9), face(150, 100, 80, 1)};
  auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 200);
  EXPECT_EQ(found->right.box.left, 150);
  detector_.left = {face(205, 100, 80, 1), face(220, 120, 120, 9)};
  detector_.right = {face(155, 100, 80, 1), face(165, 120, 120, 9)};
  found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 205) << "a larger face beside it changes nothing";
  EXPECT_EQ(found->right.box.left, 155);
}

TEST_F(StereoFaceFinderTest, TakesTheSameFaceInBothPicturesWhenTwoAreThere) {
  // The second face is farther away, and in the right picture where the first one is in the left.
  detector_.left = {face(200, 100, 80), face(250, 104, 55)};
  detector_.right = {face(205, 104, 55), face(120, 101, 80)};
  auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 200);
  EXPECT_EQ(found->right.box.left, 120);
  // The first one leaves the left picture: the right one does not stay with it.
  detector_.left = {face(250, 104, 55)};
  found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 250);
  EXPECT_EQ(found->right.box.left, 205);
}

TEST_F(StereoFaceFinderTest, TellsTwoThatAreSideBySideApartByTheirLandmarks) {
  // Boxes of one size in the same rows; the person on the left holds the mouth 9 px lower.
  corners_.lower_mouth_at = {200, 50};
  detector_.left = {face(200, 100, 80), face(300, 100, 79)};
  detector_.right = {face(170, 100, 80), face(50, 101, 81)};
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 200);
  EXPECT_EQ(found->right.box.left, 50);
}

TEST_F(StereoFaceFinderTest, SearchesEverywhereWhereTheFaceInTheSameRowsIsAnotherOne) {
  corners_.lower_mouth_at = {250, 30};  // outside the strip: further left than faces mostly are
  detector_.left = {face(250, 100, 80), face(330, 100, 60)};
  detector_.right = {face(160, 100, 80), face(30, 101, 80)};
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->right.box.left, 30);
}

TEST_F(StereoFaceFinderTest, AFaceThatIsFurtherRightInTheRightPictureIsAnotherOne) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(260, 100, 55), face(260, 200, 80)};
  EXPECT_EQ(find().error().text, "no face in the right image") << "of another size, in other rows";
}

TEST_F(StereoFaceFinderTest, AFaceOnTheWrongSideAsksWhetherTheCamerasAreExchanged) {
  detector_.left = {face(150, 100, 80)};
  detector_.right = {face(230, 103, 85)};
  EXPECT_EQ(find().error().text,
            "a face is in both pictures, but on the wrong side: are the left and the right camera "
            "exchanged?");
  std::swap(detector_.left, detector_.right);
  EXPECT_TRUE(find());
}

TEST_F(StereoFaceFinderTest, SearchesTheRightPictureInTheRowsOfTheLeftOneAndThenEverywhere) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  ASSERT_TRUE(find());
  ASSERT_EQ(detector_.searched.size(), 2u);
  EXPECT_EQ(detector_.searched[1].box.top, 100 - 0.35 * 80);
  EXPECT_EQ(detector_.searched[1].box.left, 200 - 1.6 * 80);
  EXPECT_EQ(detector_.searched[1].face_width, 80);
  state_ = {};
  detector_.right = {face(150, 220, 80)};
  EXPECT_TRUE(find()) << "the pair may be badly rectified; that is for others to judge";
  EXPECT_EQ(detector_.searched.size(), 3u);
}

TEST_F(StereoFaceFinderTest, SaysWhichPictureHasNoFaceAndForgetsIt) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  ASSERT_TRUE(find());
  ASSERT_TRUE(state_.left);
  detector_.right.clear();
  EXPECT_EQ(find().error().text, "no face in the right image");
  EXPECT_TRUE(state_.left);
  detector_.left.clear();
  EXPECT_EQ(find().error().text, "no face in the left image");
  EXPECT_FALSE(state_.left);
}

TEST_F(StereoFaceFinderTest, StretchesDarkPicturesAndTellsTheirBrightnessAsItWas) {
  const auto brightest_of = [&](std::uint8_t bright) {
    left_ = picture(PlacedFaces::kLeft, 20);
    for (std::size_t i = 10; i < left_.pixels.size() / 2; ++i) left_.pixels[i] = bright;
    detector_.left = {face(200, 200, 50)};
    const auto found = find();
    EXPECT_EQ(found.error().text, "no face in the right image");
    return detector_.brightest;
  };
  right_ = picture(1);
  EXPECT_EQ(brightest_of(150), 120) << "the right picture was searched last";
  detector_.right = {face(150, 200, 50)};
  left_ = picture(PlacedFaces::kLeft, 20);
  right_ = picture(1, 20);
  for (Picture* dark : {&left_, &right_}) {
    for (std::size_t i = 10; i < dark->pixels.size() / 2; ++i) dark->pixels[i] = 60;
  }
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(detector_.brightest, 255);
  EXPECT_EQ(found->left.mean_intensity, 20);
}

TEST_F(StereoFaceFinderTest, ABoxThatIsNoneIsNoFace) {
  detector_.left = {face(200, 100, 0), face(200, 100, -20)};
  EXPECT_EQ(find().error().text, "no face in the left image");
  DetectedFace endless = face(200, 100, 80);
  endless.box.height = std::numeric_limits<double>::infinity();
  detector_.left = {endless, face(210, 100, 60)};
  detector_.right = {face(150, 100, 60)};
  const auto found = find();
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->left.box.left, 210);
}

TEST_F(StereoFaceFinderTest, RefusesPicturesThatAreNoPair) {
  const Picture lower = Picture::of_one_grey(1, 400, 299);
  EXPECT_EQ(finder_.find({}, right_.view(), state_).error().text, "empty image");
  EXPECT_EQ(finder_.find(left_.view(), lower.view(), state_).error().text,
            "the left image is 400 x 300 pixels, the right one 400 x 299");
}

TEST_F(StereoFaceFinderTest, RefusesLandmarksThatAreNotAsManyAsTheirScheme) {
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  corners_.is_short = true;
  EXPECT_EQ(find().error().text, "left: 4 landmarks, and five has 5");
}

TEST_F(StereoFaceFinderTest, WithDetectEveryItFollowsTheLandmarksBetweenTwoDetections) {
  StereoFaceFinder finder{detector_, corners_, {.stretch_below = 100, .detect_every = 3}};
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  std::vector<std::size_t> searches;
  for (int pair = 0; pair < 7; ++pair) {
    detector_.searched.clear();
    // The landmarks move by 3 px a pair, and so does the box in which the next ones are sought.
    corners_.aside = 3 * pair;
    const auto found = finder.find(left_.view(), right_.view(), state_);
    ASSERT_TRUE(found) << found.error().text;
    searches.push_back(detector_.searched.size());
  }
  EXPECT_EQ(searches, (std::vector<std::size_t>{2, 0, 0, 2, 0, 0, 2}));
}

TEST_F(StereoFaceFinderTest, ABoxThatIsFollowedMovesAndGrowsWithItsLandmarks) {
  StereoFaceFinder finder{detector_, corners_, {.stretch_below = 100, .detect_every = 9}};
  detector_.left = {face(200, 100, 80)};
  detector_.right = {face(150, 100, 80)};
  ASSERT_TRUE(finder.find(left_.view(), right_.view(), state_));
  corners_.aside = 5;
  corners_.larger = 1.1;
  ASSERT_TRUE(finder.find(left_.view(), right_.view(), state_));
  corners_.aside = 0;
  corners_.larger = 1;
  const auto found = finder.find(left_.view(), right_.view(), state_);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->left.box.width, 88, 1e-9);
  EXPECT_NEAR(found->left.box.left + 0.5 * found->left.box.width, 245, 1e-9);
}

}  // namespace
}  // namespace armature
