// SPDX-License-Identifier: Apache-2.0
// What a scanner makes of solids: partial volumes add up to the whole, and noise follows its seed.
#include "armature/volume/phantom.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace armature {
namespace {

VolumeGeometry cube(int n, const Eigen::Vector3d& spacing) {
  VolumeGeometry geometry{.size = {n, n, n}, .spacing = spacing};
  geometry.origin = -0.5 * (n - 1) * spacing;
  return geometry;
}

/// Of everything above air, in parts of `hounsfield` above air. [m3]
double filled(const Volume& volume, double hounsfield) {
  double sum = 0;
  for (const auto voxel : volume.voxels) sum += (voxel - kAirHu) / (hounsfield - kAirHu);
  return sum * volume.geometry.spacing.prod();
}

TEST(Phantom, PartsOfVoxelsAddUpToTheVolumeOfABall) {
  for (const Eigen::Vector3d& spacing :
       {Eigen::Vector3d{0.001, 0.001, 0.001}, Eigen::Vector3d{0.0007, 0.0007, 0.002}}) {
    const Solid solid = ball({0.0003, -0.0002, 0.0004}, 0.005, 1000);
    const Volume volume = scanned(std::array{solid}, cube(24, spacing), {});
    EXPECT_NEAR(filled(volume, 1000) / (4.0 / 3 * std::numbers::pi * 125e-9), 1, 0.003);
  }
}

TEST(Phantom, ACapsuleIsAsLongAsItsLineAndRoundAtBothEnds) {
  const Solid solid{Capsule{{-0.002, 0.001, -0.005}, {0.003, -0.002, 0.006}, 0.003}, 250};
  const Volume volume = scanned(std::array{solid}, cube(24, Eigen::Vector3d::Constant(0.001)), {});
  const double length = Eigen::Vector3d{0.005, -0.003, 0.011}.norm();
  const double expected = std::numbers::pi * (9e-6 * length + 4.0 / 3 * 27e-9);
  EXPECT_NEAR(filled(volume, 250) / expected, 1, 0.003);
}

TEST(Phantom, ALaterSolidDisplacesTheOnesBefore) {
  const std::array solids{ball({0, 0, 0}, 0.01, 40), ball({0, 0, 0}, 0.005, 1000)};
  const Volume volume = scanned(solids, cube(31, Eigen::Vector3d::Constant(0.001)), {});
  EXPECT_EQ(volume.at(15, 15, 15), 1000);
  EXPECT_EQ(volume.at(15 + 7, 15, 15), 40);
  EXPECT_EQ(volume.at(30, 15, 15), kAirHu);
}

TEST(Phantom, NoiseHasItsDeviationAndFollowsItsSeed) {
  const auto geometry = cube(40, Eigen::Vector3d::Constant(0.001));
  const auto with = [&](std::uint64_t seed) {
    return scanned({}, geometry, {.noise_hu = 12, .seed = seed});
  };
  const Volume noise = with(1);
  double sum = 0;
  for (const auto voxel : noise.voxels) sum += (voxel - kAirHu) * (voxel - kAirHu);
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(noise.voxels.size())), 12, 0.2);
  EXPECT_EQ(noise.voxels, with(1).voxels);
  EXPECT_NE(noise.voxels, with(2).voxels);
}

}  // namespace
}  // namespace armature
