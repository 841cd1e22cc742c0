// SPDX-License-Identifier: Apache-2.0
#include "disparity_surface.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature::face_pose::surface {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

const StereoCamera kCamera{
    .width = 1280, .height = 720, .focal_px = 914, .cx = 639.5, .cy = 359.5, .baseline_m = 0.12};

/// The three terms of the plane through `point` with `normal`.
DisparitySurface plane_through(const Vector3d& point, const Vector3d& normal) {
  DisparitySurface plane{.middle = {600, 300}, .reach = 120};
  Eigen::Matrix3d terms;
  Vector3d disparities;
  int row = 0;
  for (const Vector2d& pixel : {Vector2d{600, 300}, Vector2d{700, 320}, Vector2d{580, 420}}) {
    const Vector3d ray{(pixel.x() - kCamera.cx) / kCamera.focal_px,
                       (pixel.y() - kCamera.cy) / kCamera.focal_px, 1};
    const double depth = normal.dot(point) / normal.dot(ray);
    terms.row(row) = DisparitySurface::terms(plane.local(pixel)).head<3>();
    disparities[row++] = kCamera.focal_px * kCamera.baseline_m / depth;
  }
  plane.c.head<3>() = terms.inverse() * disparities;
  return plane;
}

TEST(DisparitySurface, OfAPlaneIsExactEverywhereAndTellsItsNormal) {
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int i = 0; i < 200; ++i) {
    const Vector3d point{0.1 * unit(random), 0.1 * unit(random), 0.6 + 0.2 * unit(random)};
    const Vector3d normal = Vector3d{unit(random), unit(random), -1.5}.normalized();
    const DisparitySurface plane = plane_through(point, normal);
    EXPECT_TRUE(plane.is_plane());
    EXPECT_LT((plane.plane_normal(kCamera) - normal).norm(), 1e-9) << "seed 5, round " << i;
    const Vector3d elsewhere = plane.point({820, 190}, kCamera);
    EXPECT_LT(std::abs((elsewhere - point).dot(normal)), 1e-9) << "seed 5, round " << i;
  }
}

TEST(DisparitySurface, TheNormalsDerivativeIsTheSlopeOfTheNormal) {
  const DisparitySurface plane =
      plane_through({0.02, 0.05, 0.5}, Vector3d{0.3, -0.2, -1}.normalized());
  const Eigen::Matrix3d derivative = plane.plane_normal_derivative(kCamera);
  for (int i = 0; i < 3; ++i) {
    DisparitySurface more = plane, less = plane;
    more.c[i] += 1e-4;
    less.c[i] -= 1e-4;
    const Vector3d slope = (more.plane_normal(kCamera) - less.plane_normal(kCamera)) / 2e-4;
    EXPECT_LT((derivative.col(i) - slope).norm(), 1e-6 * derivative.norm()) << i;
  }
}

TEST(DisparitySurface, TheTangentTouchesAndHasTheSlopeOfTheSurface) {
  DisparitySurface curved{.middle = {600, 300}, .reach = 100};
  curved.c << 200, 3, -2, 1.5, 0.7, -2.2;
  const Vector2d pixel{650, 270}, beside{650.01, 270.02};
  const DisparitySurface tangent = curved.tangent(pixel);
  EXPECT_TRUE(tangent.is_plane());
  EXPECT_FALSE(curved.is_plane());
  EXPECT_NEAR(tangent.at(pixel), curved.at(pixel), 1e-12);
  EXPECT_NEAR(tangent.at(beside), curved.at(beside), 1e-6);
}

TEST(DisparitySurface, IsHollowWhereItComesNearerAwayFromItsMiddle) {
  DisparitySurface curved{.middle = {600, 300}, .reach = 100};
  curved.c << 200, 3, -2, -1.5, 0, -2.2;
  EXPECT_NEAR(curved.hollowness(), -1.5, 1e-12);
  curved.c[4] = 6;  // a saddle
  EXPECT_NEAR(curved.hollowness(), -1.85 + std::hypot(0.35, 3), 1e-12);
  const Vector2d along =
      curved.middle + curved.reach * Vector2d{std::cos(0.7282), std::sin(0.7282)};
  EXPECT_NEAR(curved.at(along) - curved.tangent(curved.middle).at(along), curved.hollowness(),
              1e-4);
}

}  // namespace
}  // namespace armature::face_pose::surface
