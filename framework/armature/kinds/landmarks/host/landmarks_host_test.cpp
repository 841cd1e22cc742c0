// SPDX-License-Identifier: Apache-2.0
// The host of the landmark finders: 1. one answer for each pair of pictures, under the header of
// the left one, 2. a face is sought where it was, 3. pictures that are none are
// answered with their exact reason.
#include <gtest/gtest.h>

#include <stdexcept>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::landmarks_host {
namespace {

/// A face in every picture whose first pixel is 200; where it is known about, one pixel wider than
/// it was, about the same centre.
class FirstPixel final : public FaceDetector {
 public:
  static inline bool throws = false;

  Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                             const SearchRegion& region) override {
    if (throws) throw std::runtime_error{"the matrix is singular"};
    if (image.data[0] != 200) return std::vector<DetectedFace>{};
    const double more = region.face_width.value_or(0);
    return std::vector{DetectedFace{{1 - more / 2, 0, more + 1, 1}, 1.5}};
  }
};

/// Landmarks along a row.
class InARow final : public LandmarkFinder {
 public:
  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView&, const PixelBox& face) override {
    std::vector<Landmark> points;
    for (int i = 0; i < 5; ++i) points.push_back({.point = {face.width + i, 0.5}, .sigma = 0.25});
    return points;
  }
};

PluginRegistry& plugins() {
  static PluginRegistry& registry = [&]() -> PluginRegistry& {
    PluginRegistry& built = built_plugins_with<FirstPixel>(
        "{armature_plugin: 1, id: detector/first_pixel, kind: detector}");
    built.add<InARow>("{armature_plugin: 1, id: landmarks/in_a_row, kind: landmarks}");
    return built;
  }();
  return registry;
}

/// 4 x 2 pixels in rows of 6 bytes, of which two count for nothing.
msg::Image image(double stamp_s, std::uint8_t first) {
  msg::Image message;
  write_header(message.header_(), Time{} + seconds(stamp_s), "left_camera_optical");
  message.width_(4);
  message.height_(2);
  message.step_(6);
  message.encoding_("mono8");
  message.data_({first, 10, 10, 10, 99, 99, 10, 10, 10, 10, 99, 99});
  return message;
}

class LandmarksHostTest : public ::testing::Test {
 protected:
  msg::FaceLandmarks see(const msg::Image& left, const msg::Image& right) {
    host_.send("left_image", left);
    host_.send("right_image", right);
    EXPECT_TRUE(host_.triggered());
    host_.step(to_seconds(stamp_of(left.header_().stamp_()) - Time{}));
    const auto answers = host_.take<msg::FaceLandmarks>("landmarks");
    EXPECT_EQ(answers.size(), 1u);
    return answers.empty() ? msg::FaceLandmarks{} : answers.front();
  }
  ComponentHarness host_{plugins(),
                         {.component = "{plugin: landmarks/in_a_row, params: {stretch_below: 0}, "
                                       "detector: {plugin: detector/first_pixel}}",
                          .robot = {}}};
};

TEST_F(LandmarksHostTest, TellsWhatWasFoundUnderTheHeaderOfThePictures) {
  const msg::Image picture = image(0.5, 200);
  const msg::FaceLandmarks answer = see(picture, image(0.5, 200));
  EXPECT_EQ(answer.header_(), picture.header_());
  EXPECT_TRUE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "");
  EXPECT_EQ(answer.scheme_(), "five");
  EXPECT_EQ(answer.left_(), (std::vector<double>{1, 0.5, 2, 0.5, 3, 0.5, 4, 0.5, 5, 0.5}));
  EXPECT_EQ(answer.right_(), (std::vector<double>{2, 0.5, 3, 0.5, 4, 0.5, 5, 0.5, 6, 0.5}));
  EXPECT_EQ(answer.left_sigma_(), std::vector<double>(5, 0.25));
  EXPECT_EQ(answer.right_sigma_(), std::vector<double>(5, 0.25));
  EXPECT_EQ(answer.left_box_(), (std::array<double, 4>{1, 0, 1, 1}));
  EXPECT_EQ(answer.right_box_(), (std::array<double, 4>{0.5, 0, 2, 1}));
  EXPECT_EQ(answer.score_(), 1.5);
  EXPECT_EQ(answer.face_intensity_(), 10);
  EXPECT_EQ(answer.image_intensity_(), (200 + 7 * 10) / 8.0);
}

TEST_F(LandmarksHostTest, WaitsForBothPicturesOfAPairAndAnswersItOnce) {
  host_.send("left_image", image(1, 200));
  host_.send("right_image", image(2, 200));
  EXPECT_FALSE(host_.triggered());
  host_.step(2);
  EXPECT_TRUE(host_.take<msg::FaceLandmarks>("landmarks").empty());
  host_.send("left_image", image(2, 200));
  host_.step(2.1);
  EXPECT_EQ(host_.take<msg::FaceLandmarks>("landmarks").size(), 1u);
  host_.step(2.2);
  EXPECT_TRUE(host_.take<msg::FaceLandmarks>("landmarks").empty());
}

TEST_F(LandmarksHostTest, LooksWhereTheFaceWasUntilItIsLost) {
  EXPECT_EQ(see(image(1, 200), image(1, 200)).left_box_()[2], 1);
  EXPECT_EQ(see(image(2, 200), image(2, 200)).left_box_()[2], 2);
  EXPECT_FALSE(see(image(3, 0), image(3, 0)).valid_());
  EXPECT_EQ(see(image(4, 200), image(4, 200)).left_box_()[2], 3);
  EXPECT_FALSE(see(image(5, 0), image(5, 0)).valid_());
  EXPECT_FALSE(see(image(6, 0), image(6, 0)).valid_());
  EXPECT_EQ(see(image(7, 200), image(7, 200)).left_box_()[2], 1);
}

TEST_F(LandmarksHostTest,
       AnswersAPictureWithoutAFaceWithItsBrightnessAndNothingOfThePictureBefore) {
  ASSERT_TRUE(see(image(1, 200), image(1, 200)).valid_());
  const msg::FaceLandmarks none = see(image(2, 90), image(2, 90));
  EXPECT_FALSE(none.valid_());
  EXPECT_EQ(none.reason_(), "no face in the left image");
  EXPECT_EQ(none.image_intensity_(), (90 + 7 * 10) / 8.0);
  EXPECT_EQ(none.face_intensity_(), 0);
  EXPECT_EQ(none.score_(), 0);
  EXPECT_EQ(none.left_box_(), (std::array<double, 4>{}));
  EXPECT_TRUE(none.left_().empty());
  EXPECT_TRUE(none.right_().empty());
  EXPECT_TRUE(none.left_sigma_().empty());
}

TEST_F(LandmarksHostTest, AnswersPicturesThatAreNoneWithTheirReason) {
  double stamp = 0;
  const auto refusal = [&](auto change_left, auto change_right) {
    ++stamp;
    msg::Image left = image(stamp, 200), right = image(stamp, 200);
    change_left(left);
    change_right(right);
    const msg::FaceLandmarks answer = see(left, right);
    EXPECT_FALSE(answer.valid_());
    EXPECT_EQ(stamp_of(answer.header_().stamp_()), Time{} + seconds(stamp));
    EXPECT_TRUE(std::isfinite(answer.image_intensity_()));
    return answer.reason_();
  };
  const auto as_it_is = [](msg::Image&) {};
  EXPECT_EQ(refusal([](msg::Image& i) { i.encoding_("rgb8"); }, as_it_is),
            "left: the image is 'rgb8', not mono8");
  EXPECT_EQ(refusal(as_it_is, [](msg::Image& i) { i.data_().pop_back(); }),
            "right: an image of 4 x 2 pixels with 11 bytes in steps of 6");
  EXPECT_EQ(refusal([](msg::Image& i) { i.step_(3); }, as_it_is),
            "left: an image of 4 x 2 pixels with 12 bytes in steps of 3");
  EXPECT_EQ(refusal([](msg::Image& i) { i.height_(0); }, as_it_is),
            "left: an image of 4 x 0 pixels with 12 bytes in steps of 6");
  EXPECT_EQ(refusal(as_it_is, [](msg::Image& i) { i.width_(3); }),
            "the left image is 4 x 2 pixels, the right one 3 x 2");
  EXPECT_TRUE(see(image(50, 200), image(50, 200)).valid_());
}

TEST_F(LandmarksHostTest, AnExceptionOfADetectorIsAReasonAndItLooksEverywhereAgain) {
  const msg::Image face = image(0.5, 200);
  EXPECT_EQ(see(face, face).left_box_()[2], 1);
  EXPECT_EQ(see(face, face).left_box_()[2], 2);
  FirstPixel::throws = true;
  const msg::FaceLandmarks answer = see(face, face);
  FirstPixel::throws = false;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "the plugin threw: the matrix is singular");
  EXPECT_EQ(see(face, face).left_box_()[2], 1);
}

}  // namespace
}  // namespace armature::landmarks_host
