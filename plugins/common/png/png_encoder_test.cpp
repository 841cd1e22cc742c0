// SPDX-License-Identifier: Apache-2.0
// What is encoded is what OpenCV decodes, to the last bit.
#include "png_encoder.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <stdexcept>
#include <vector>

namespace armature::png {
namespace {

Pixels pixels_of(const cv::Mat& picture) {
  return {.width = picture.cols,
          .height = picture.rows,
          .channels = picture.channels(),
          .data = picture.data,
          .stride = picture.step};
}

cv::Mat decoded(const std::string& png) {
  return cv::imdecode(std::vector<char>{png.begin(), png.end()}, cv::IMREAD_UNCHANGED);
}

cv::Mat drawn_by_lot(int height, int width, int type) {
  cv::Mat picture(height, width, type);
  std::mt19937 random{7};
  for (int v = 0; v < height; ++v) {
    for (int i = 0; i < width * picture.channels(); ++i) {
      picture.ptr(v)[i] = static_cast<std::uint8_t>(random());
    }
  }
  return picture;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PngEncoder, GivesGreyAndColourBackToTheLastBit) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const auto& [height, width] : {std::pair{1, 1}, {3, 5}, {37, 64}}) {
      const cv::Mat picture = drawn_by_lot(height, width, type);
      EXPECT_TRUE(same(decoded(encoded(pixels_of(picture))), picture))
          << height << " x " << width << ", " << picture.channels() << " channels";
    }
  }
}

TEST(PngEncoder, TakesAPartOfAPicture) {
  const cv::Mat part = drawn_by_lot(20, 30, CV_8UC3)(cv::Rect{4, 5, 11, 7});
  EXPECT_TRUE(same(decoded(encoded(pixels_of(part))), part));
}

TEST(PngEncoder, RefusesAPictureWithoutPixelsAndOneOfTwoChannels) {
  const std::vector<std::uint8_t> bytes(8);
  EXPECT_THROW(encoded({.width = 0, .height = 2, .channels = 1, .data = bytes.data(), .stride = 1}),
               std::invalid_argument);
  EXPECT_THROW(encoded({.width = 2, .height = 2, .channels = 2, .data = bytes.data(), .stride = 4}),
               std::invalid_argument);
}

}  // namespace
}  // namespace armature::png
