// SPDX-License-Identifier: Apache-2.0
#include "luma.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

namespace armature::camera::v4l2 {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// 1 2 3 4 above 5 6 7 8, colours 99, and 77 behind each row.
const Bytes kGrey{1, 2, 3, 4, 77, 5, 6, 7, 8, 77};
const Bytes kYuyv{1, 99, 2, 99, 3, 99, 4, 99, 77, 5, 99, 6, 99, 7, 99, 8, 99, 77};
const Bytes kUyvy{99, 1, 99, 2, 99, 3, 99, 4, 77, 99, 5, 99, 6, 99, 7, 99, 8, 77};
const Bytes kNv12{1, 2, 3, 4, 77, 5, 6, 7, 8, 77, 99, 99, 99, 99, 77};

Expected<Bytes> luma(Layout layout, const Bytes& bytes, std::size_t stride) {
  jpeg::JpegDecoder decoder;
  Bytes pixels;
  return luma_of(layout, bytes, 4, 2, stride, decoder, pixels).map([&] { return pixels; });
}

TEST(Luma, IsTheBrightnessOfEveryLayoutWithoutWhatStandsBehindRows) {
  const Bytes expected{1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(luma(Layout::grey, kGrey, 5).value(), expected);
  EXPECT_EQ(luma(Layout::yuyv, kYuyv, 9).value(), expected);
  EXPECT_EQ(luma(Layout::uyvy, kUyvy, 9).value(), expected);
  EXPECT_EQ(luma(Layout::nv12, kNv12, 5).value(), expected);
}

TEST(Luma, OfAPictureThatIsShortIsRefusedWithItsSize) {
  EXPECT_TRUE(luma(Layout::grey, Bytes(kGrey.begin(), kGrey.end() - 1), 5))
      << "what is behind the last row";
  EXPECT_EQ(luma(Layout::grey, Bytes(kGrey.begin(), kGrey.end() - 2), 5).error().text,
            "a picture has 8 bytes, 5 a row; 4 x 2 pixels need 9");
  EXPECT_FALSE(luma(Layout::yuyv, Bytes(kYuyv.begin(), kYuyv.end() - 2), 9));
  EXPECT_FALSE(luma(Layout::grey, {}, 5));
  EXPECT_FALSE(luma(Layout::grey, kGrey, 3)) << "rows that overlap";
}

TEST(Luma, OfAJpegIsThatOfItsPixels) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(2, 4, CV_8UC1, cv::Scalar{123}), jpeg);
  const auto pixels = luma(Layout::mjpeg, jpeg, 0);
  ASSERT_TRUE(pixels) << pixels.error().text;
  for (const int grey : *pixels) EXPECT_NEAR(grey, 123, 2);
}

}  // namespace
}  // namespace armature::camera::v4l2
