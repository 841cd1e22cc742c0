// SPDX-License-Identifier: Apache-2.0
// What another library has compressed is read, and what is damaged is refused.
#include "jpeg_decoder.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

namespace armature::jpeg {
namespace {

constexpr int kAcross = 64, kDown = 48;

std::vector<std::uint8_t> compressed(int type) {
  cv::Mat picture(kDown, kAcross, type, cv::Scalar{40, 40, 40});
  picture.colRange(kAcross / 2, kAcross).setTo(cv::Scalar{200, 200, 200});
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes);
  return bytes;
}

TEST(JpegDecoder, ReadsTheBrightnessOfGreyAndColouredPictures) {
  JpegDecoder decoder;
  for (const int type : {CV_8UC1, CV_8UC3}) {
    std::vector<std::uint8_t> pixels;
    const auto decoded = decoder.decode_gray(compressed(type), kAcross, kDown, pixels);
    ASSERT_TRUE(decoded) << decoded.error().text;
    ASSERT_EQ(pixels.size(), kAcross * kDown);
    EXPECT_NEAR(pixels[20 * kAcross + 8], 40, 4);
    EXPECT_NEAR(pixels[20 * kAcross + 56], 200, 4);
  }
}

TEST(JpegDecoder, RefusesWhatIsCutOffOfAnotherSizeOrNoPicture) {
  JpegDecoder decoder;
  std::vector<std::uint8_t> pixels, bytes = compressed(CV_8UC1);
  EXPECT_EQ(decoder.decode_gray(bytes, kAcross, 2 * kDown, pixels).error().text,
            "a JPEG has 64 x 48 pixels instead of 64 x 96");
  const std::vector<std::uint8_t> cut(bytes.begin(), bytes.end() - 20);
  EXPECT_NE(
      decoder.decode_gray(cut, kAcross, kDown, pixels).error().text.find("cannot be unpacked"),
      std::string::npos);
  EXPECT_FALSE(decoder.decode_gray({}, kAcross, kDown, pixels));
  EXPECT_FALSE(decoder.decode_gray(std::vector<std::uint8_t>(1000, 7), kAcross, kDown, pixels));
  EXPECT_TRUE(decoder.decode_gray(bytes, kAcross, kDown, pixels)) << "and the next one is read";
}

}  // namespace
}  // namespace armature::jpeg
