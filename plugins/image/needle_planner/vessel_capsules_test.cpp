// SPDX-License-Identifier: Apache-2.0
#include "vessel_capsules.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.001, kVoxel = 1e-9;

/// The points of a grid within `radius` of a quarter circle of radius `bend`.
std::vector<Vector3d> bent_vessel(double bend, double radius) {
  std::vector<Vector3d> points;
  for (double x = -0.01; x < bend + 0.01; x += kStep) {
    for (double y = -0.01; y < bend + 0.01; y += kStep) {
      for (double z = -0.01; z < 0.01; z += kStep) {
        if (x < 0 || y < 0) continue;
        if (std::hypot(std::hypot(x, y) - bend, z) <= radius) points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

void expect_inside(const std::vector<Vector3d>& points,
                   const std::vector<ForbiddenZone>& capsules) {
  for (const Vector3d& point : points) {
    double nearest = 1;
    for (const auto& zone : capsules) nearest = std::min(nearest, clearance(point, point, zone));
    EXPECT_LT(nearest, 1e-9);
  }
}

TEST(VesselCapsules, HoldAllOfABentVesselAndAreNotMuchThicker) {
  const auto points = bent_vessel(0.04, 0.003);
  const auto capsules = vessel_capsules(points, kVoxel);
  EXPECT_GT(capsules.size(), 1u);
  expect_inside(points, capsules);
  for (const ForbiddenZone& capsule : capsules) EXPECT_LT(capsule.radius_m, 0.006);
}

TEST(VesselCapsules, OfARoundPartIsABall) {
  std::vector<Vector3d> points;
  for (const Vector3d& point : bent_vessel(0.0001, 0.004)) points.push_back(point);
  const auto capsules = vessel_capsules(points, kVoxel);
  ASSERT_EQ(capsules.size(), 1u);
  expect_inside(points, capsules);
}

TEST(VesselCapsules, OfNoPointsAreNone) { EXPECT_TRUE(vessel_capsules({}, kVoxel).empty()); }

TEST(VesselCapsules, OfOnePointAreAPoint) {
  const auto capsules = vessel_capsules({{0.01, 0.02, 0.03}}, kVoxel);
  ASSERT_EQ(capsules.size(), 1u);
  EXPECT_LT((capsules[0].from - Vector3d{0.01, 0.02, 0.03}).norm(), 1e-12);
  EXPECT_LT(capsules[0].radius_m, 1e-9);
}

}  // namespace
}  // namespace armature::image::needle_planner
