// SPDX-License-Identifier: Apache-2.0
// Cutting a square out of an image: 1. every value is that of its place, 2. no pixel is skipped,
// 3. the edge goes on.
#include "crop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "armature/kinds/face_picture.hpp"

namespace armature::landmarks::face_mesh {
namespace {

/// Brighter to the right by a grey value a column, and down by two a row.
Picture slope() {
  Picture picture = Picture::of_one_grey(0, 60, 60);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    picture.pixels[i] = static_cast<std::uint8_t>(i % 60 + 2 * (i / 60));
  }
  return picture;
}

TEST(Crop, ShowsEveryPlaceOfTheImageWhereItSaysThatItIs) {
  const Picture picture = slope();
  for (const double side : {10.0, 20.0, 33.0, 45.0}) {  // smaller than the 20 px, as large, larger
    const Crop crop{.middle = {28.25, 30.5}, .side = side};
    std::vector<float> grey(400);
    cut(picture.view(), crop, 20, grey);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d at = crop.in_image({i % 20, i / 20}, 20);
      EXPECT_NEAR(255 * grey[static_cast<std::size_t>(i)], at.x() + 2 * at.y(), 1e-2)
          << "of " << side;
    }
  }
}

TEST(Crop, AveragesAllPixelsThatFallTogether) {
  Picture stripes = Picture::of_one_grey(0, 64, 64);
  for (std::size_t i = 0; i < stripes.pixels.size(); i += 4) stripes.pixels[i] = 200;
  std::vector<float> grey(256);
  cut(stripes.view(), {.middle = {31.5, 31.5}, .side = 64}, 16, grey);  // 4 x 4 pixels into one
  for (const float value : grey) EXPECT_NEAR(255 * value, 50, 1e-3);
}

TEST(Crop, GoesOnWithTheEdgeOutsideOfTheImage) {
  std::vector<float> grey(100);
  cut(slope().view(), {.middle = {-500, 29}, .side = 20}, 10, grey);
  EXPECT_NEAR(255 * grey[0], 2 * (29 - 9), 1e-3);
  cut(slope().view(), {.middle = {900, 900}, .side = 1e4}, 10, grey);
  EXPECT_NEAR(255 * grey[99], 59 + 2 * 59, 1e-3);
}

}  // namespace
}  // namespace armature::landmarks::face_mesh
