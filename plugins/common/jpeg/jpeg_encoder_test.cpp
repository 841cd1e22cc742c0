// SPDX-License-Identifier: Apache-2.0
// What was compressed is read again by another library.
#include "jpeg_encoder.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

namespace armature::jpeg {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 48, kPadding = 5;

/// The left half dark, the right half bright; of colours red. Rows are longer than they need to be.
msg::Image picture(const std::string& encoding, std::uint32_t channels) {
  msg::Image image;
  image.encoding_(encoding);
  image.width_(kWidth);
  image.height_(kHeight);
  image.step_(kWidth * channels + kPadding);
  image.data_().assign(std::size_t{kHeight} * image.step_(), 0);
  const std::uint32_t red = encoding.starts_with("bgr") ? 2 : 0;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = kWidth / 2; x < kWidth; ++x) {
      image.data_()[y * image.step_() + x * channels + red] = 200;
    }
  }
  return image;
}

cv::Mat decoded(const msg::Image& image) {
  std::vector<std::uint8_t> jpeg;
  const auto encoded = JpegEncoder{90}.encode(image, jpeg);
  EXPECT_TRUE(encoded) << encoded.error().text;
  return cv::imdecode(jpeg, cv::IMREAD_UNCHANGED);
}

std::string refusal(const msg::Image& image) {
  std::vector<std::uint8_t> jpeg;
  const auto encoded = JpegEncoder{90}.encode(image, jpeg);
  return encoded ? "" : encoded.error().text;
}

TEST(JpegEncoder, KeepsAGreyPictureGrey) {
  const cv::Mat grey = decoded(picture("mono8", 1));
  ASSERT_EQ(grey.size(), cv::Size(kWidth, kHeight));
  ASSERT_EQ(grey.channels(), 1);
  EXPECT_NEAR(grey.at<std::uint8_t>(20, 8), 0, 4);
  EXPECT_NEAR(grey.at<std::uint8_t>(20, 56), 200, 4);
}

TEST(JpegEncoder, KeepsRedRedWhateverTheOrderOfTheColours) {
  for (const auto& [encoding, channels] : std::vector<std::pair<std::string, std::uint32_t>>{
           {"rgb8", 3}, {"bgr8", 3}, {"rgba8", 4}, {"bgra8", 4}}) {
    const cv::Mat colour = decoded(picture(encoding, channels));
    ASSERT_EQ(colour.size(), cv::Size(kWidth, kHeight)) << encoding;
    ASSERT_EQ(colour.channels(), 3) << encoding;
    const auto pixel = colour.at<cv::Vec3b>(20, 56);  // OpenCV has blue first
    EXPECT_NEAR(pixel[2], 200, 8) << encoding;
    EXPECT_NEAR(pixel[0], 0, 8) << encoding;
  }
}

TEST(JpegEncoder, RefusesWhatIsNoPicture) {
  EXPECT_EQ(refusal(picture("16UC1", 2)),
            "a picture is '16UC1', which is none of mono8, rgb8, bgr8, rgba8, bgra8");
  msg::Image none = picture("mono8", 1);
  none.width_(0);
  EXPECT_EQ(refusal(none), "a picture of 0 x 48 pixels cannot be a JPEG");
  msg::Image cut = picture("mono8", 1);
  cut.data_().pop_back();
  EXPECT_EQ(refusal(cut), "") << "the last row needs no padding";
  cut.data_().resize(cut.data_().size() - kPadding);
  EXPECT_EQ(refusal(cut), "a picture of 64 x 48 pixels has 3306 bytes, 69 a row");
  msg::Image narrow = picture("rgb8", 3);
  narrow.step_(kWidth);
  EXPECT_NE(refusal(narrow), "");
}

}  // namespace
}  // namespace armature::jpeg
