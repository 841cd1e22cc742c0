// SPDX-License-Identifier: Apache-2.0
// The blur: 1. a point becomes a Gaussian of its sigma, 2. one grey stays itself to the edges, 3.
// what lies outside the region is not written.
#include "armature/scene/gaussian_blur.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace armature::scene {
namespace {

constexpr int kBlurWidth = 60, kBlurHeight = 40;

float& pixel(std::vector<float>& picture, int u, int v) {
  return picture[static_cast<std::size_t>(v * kBlurWidth + u)];
}
std::vector<float> one_grey(float grey) {
  return std::vector<float>(static_cast<std::size_t>(kBlurWidth * kBlurHeight), grey);
}
constexpr PixelRegion kWholePicture{0, 0, kBlurWidth, kBlurHeight};

TEST(GaussianBlur, MakesAGaussianOfAPoint) {
  for (const double sigma : {0.5, 1.0, 2.7}) {
    SCOPED_TRACE(sigma);
    std::vector<float> picture = one_grey(0);
    pixel(picture, 30, 20) = 1000;
    GaussianBlur blur{sigma};
    EXPECT_EQ(blur.reach(), static_cast<int>(std::ceil(3 * sigma)));
    blur.apply(picture, kBlurWidth, kWholePicture);
    double sum = 0, second = 0;
    for (int v = 0; v < kBlurHeight; ++v) {
      for (int u = 0; u < kBlurWidth; ++u) {
        const double value = pixel(picture, u, v);
        sum += value;
        second += value * (u - 30) * (u - 30);
      }
    }
    EXPECT_NEAR(sum, 1000, 1e-2);
    // The tails beyond 3 sigma are missing; half a pixel is sampled coarsely.
    EXPECT_NEAR(std::sqrt(second / sum), sigma, 0.08 * sigma);
    EXPECT_NEAR(pixel(picture, 31, 20) / pixel(picture, 30, 20), std::exp(-0.5 / (sigma * sigma)),
                1e-5);
    EXPECT_NEAR(pixel(picture, 30, 19), pixel(picture, 29, 20), 1e-3);
  }
}

TEST(GaussianBlur, LeavesOneGreyAsItIsAlsoAtTheEdges) {
  std::vector<float> picture = one_grey(90);
  GaussianBlur{2}.apply(picture, kBlurWidth, kWholePicture);
  for (const float value : picture) EXPECT_NEAR(value, 90, 1e-4);
}

TEST(GaussianBlur, WritesNothingOutsideTheRegionAndReadsWhatLiesThere) {
  std::vector<float> whole = one_grey(0);
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<float>(i * i % 251);
  std::vector<float> part = whole;
  const std::vector<float> before = whole;
  GaussianBlur blur{1};
  blur.apply(whole, kBlurWidth, kWholePicture);
  const PixelRegion region{10, 5, 31, 22};
  blur.apply(part, kBlurWidth, region);
  for (int v = 0; v < kBlurHeight; ++v) {
    for (int u = 0; u < kBlurWidth; ++u) {
      const auto i = static_cast<std::size_t>(v * kBlurWidth + u);
      const bool inside =
          u >= region.left && u < region.right && v >= region.top && v < region.bottom;
      EXPECT_EQ(part[i], inside ? whole[i] : before[i]) << u << ", " << v;
    }
  }
}

TEST(GaussianBlur, OfNoWidthDoesNothing) {
  std::vector<float> picture = one_grey(0);
  pixel(picture, 3, 3) = 7;
  const std::vector<float> before = picture;
  GaussianBlur{0}.apply(picture, kBlurWidth, kWholePicture);
  GaussianBlur{3}.apply(picture, kBlurWidth, PixelRegion{5, 5, 5, 9});
  EXPECT_EQ(picture, before);
}

}  // namespace
}  // namespace armature::scene
