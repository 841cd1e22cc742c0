// SPDX-License-Identifier: Apache-2.0
// The host of the landmark finders: 1. one answer for each pair of pictures, under the header of
// the left one, 2. the finder's memory is kept between pictures, 3. pictures that are none are
// answered with their exact reason.
#include <gtest/gtest.h>

#include <stdexcept>

#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component_bench.hpp"
#include "armature/runtime/test_plugins.hpp"

namespace armature::landmarks_host {
namespace {

/// A face wherever the first pixel is 200, its box as wide as the pictures it was seen in before.
class FirstPixel final : public LandmarkFinder {
 public:
  static inline bool throws = false;

  Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right,
                                 State& state) override {
    if (auto wrong = invalid_input(left, right)) return refuse(*wrong);
    if (left.data[0] != 200) {
      state = {};
      return refuse("no face in the left image");
    }
    const double width = state.left ? state.left->width + 1 : 1;
    state.left = PixelBox{1, 2, width, 4};
    if (throws) throw std::runtime_error{"the matrix is singular"};
    StereoLandmarks found;
    for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
      found.left.points[i] = {static_cast<double>(i), 0.5};
      found.right.points[i] = {static_cast<double>(i) - 10, 0.25};
    }
    found.left.box = *state.left;
    found.right.box = {5, 6, 7, 8};
    found.left.score = 1.5;
    found.left.mean_intensity = 33;
    return found;
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<FirstPixel>(
      "{armature_plugin: 1, id: landmarks/first_pixel, kind: landmarks}");
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
  ComponentBench host_{plugins(),
                       {.component = "{plugin: landmarks/first_pixel}", .robot = {}, .rig = {}}};
};

TEST_F(LandmarksHostTest, TellsWhatWasFoundUnderTheHeaderOfThePictures) {
  const msg::Image picture = image(0.5, 200);
  const msg::FaceLandmarks answer = see(picture, image(0.5, 200));
  EXPECT_EQ(answer.header_(), picture.header_());
  EXPECT_TRUE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "");
  ASSERT_EQ(answer.left_().size(), 136u);
  ASSERT_EQ(answer.right_().size(), 136u);
  EXPECT_EQ(answer.left_()[2 * 67], 67);
  EXPECT_EQ(answer.left_()[2 * 67 + 1], 0.5);
  EXPECT_EQ(answer.right_()[0], -10);
  EXPECT_EQ(answer.left_box_(), (std::array<double, 4>{1, 2, 1, 4}));
  EXPECT_EQ(answer.right_box_(), (std::array<double, 4>{5, 6, 7, 8}));
  EXPECT_EQ(answer.score_(), 1.5);
  EXPECT_EQ(answer.face_intensity_(), 33);
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

TEST_F(LandmarksHostTest, KeepsTheFindersMemoryUntilTheFaceIsLost) {
  EXPECT_EQ(see(image(1, 200), image(1, 200)).left_box_()[2], 1);
  EXPECT_EQ(see(image(2, 200), image(2, 200)).left_box_()[2], 2);
  EXPECT_FALSE(see(image(3, 0), image(3, 0)).valid_());
  EXPECT_EQ(see(image(4, 200), image(4, 200)).left_box_()[2], 1);
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

TEST_F(LandmarksHostTest, AnExceptionOfTheFinderIsAReasonAndItStartsColdAgain) {
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
