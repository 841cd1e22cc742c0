// SPDX-License-Identifier: Apache-2.0
#include "lens.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature::stereo {
namespace {

TEST(Lens, FindsTheRayOfEveryPixelThatItProjects) {
  constexpr std::uint64_t kSeed = 4;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int model = 0; model < 200; ++model) {
    Lens lens{.fx = 700 + 50 * unit(random), .fy = 700, .cx = 640, .cy = 360};
    lens.distortion = {0.35 * unit(random),  0.15 * unit(random), 0.003 * unit(random),
                       0.003 * unit(random), 0.05 * unit(random), 0.1 * unit(random),
                       0.05 * unit(random),  0.01 * unit(random)};
    // Off the axis p1 and p2 bend a little, too, so not quite up to where the polynomial turns
    // back.
    const double reach = std::min(0.9 * lens.max_radius(), 1.0);
    for (int i = 0; i < 50; ++i) {
      const double angle = M_PI * unit(random), r = reach * std::sqrt(std::abs(unit(random)));
      const Eigen::Vector2d ray{r * std::cos(angle), r * std::sin(angle)};
      const auto found = lens.ray_of(lens.project(ray));
      ASSERT_TRUE(found) << "model " << model << ", ray " << ray.transpose();
      ASSERT_LT((*found - ray).norm(), 1e-10) << "model " << model << ", ray " << ray.transpose();
    }
  }
}

TEST(Lens, BendsAsTheModelsFormulaSays) {
  const Lens lens{.fx = 500,
                  .fy = 510,
                  .cx = 320,
                  .cy = 240,
                  .distortion = {0.1, 0.02, 0.001, 0.002, 0.003, 0.04, 0.005, 0.0006}};
  const double x = 0.3, y = -0.4, r2 = 0.25;
  const double factor = (1 + 0.1 * r2 + 0.02 * r2 * r2 + 0.003 * r2 * r2 * r2) /
                        (1 + 0.04 * r2 + 0.005 * r2 * r2 + 0.0006 * r2 * r2 * r2);
  const Eigen::Vector2d bent{x * factor + 2 * 0.001 * x * y + 0.002 * (r2 + 2 * x * x),
                             y * factor + 0.001 * (r2 + 2 * y * y) + 2 * 0.002 * x * y};
  const Eigen::Vector2d pixel = lens.project({x, y});
  EXPECT_NEAR(pixel.x(), 500 * bent.x() + 320, 1e-12);
  EXPECT_NEAR(pixel.y(), 510 * bent.y() + 240, 1e-12);
}

TEST(Lens, ReachesAsFarAsItsPolynomialRises) {
  Lens lens{.fx = 500, .fy = 500, .cx = 320, .cy = 240};
  EXPECT_EQ(lens.max_radius(), 10);
  lens.distortion[0] = -0.3;  // r - 0.3 r^3 rises until 0.9 r^2 = 1
  EXPECT_NEAR(lens.max_radius(), 1 / std::sqrt(0.9), 0.0051);
  EXPECT_FALSE(lens.ray_of({320 + 500 * 0.8, 240})) << "0.703 is the farthest that is seen";
  EXPECT_TRUE(lens.ray_of({320 + 500 * 0.7, 240}));
  lens.distortion = {0, 0, 0, 0, 0, -1, 0, 0};  // the denominator 1 - r^2 ends at 1
  EXPECT_LE(lens.max_radius(), 1);
}

}  // namespace
}  // namespace armature::stereo
