// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace armature {
namespace {

/// Turned, shifted, with voxels of three lengths; its values rise by `slope` a metre of the image.
Volume ramp(const Eigen::Vector3d& slope) {
  Volume volume{.geometry = {.size = {20, 24, 16}, .spacing = {0.001, 0.0008, 0.002}}};
  volume.geometry.direction =
      Eigen::AngleAxisd{0.4, Eigen::Vector3d{1, -2, 3}.normalized()}.toRotationMatrix();
  volume.geometry.origin = {0.1, -0.05, 0.2};
  for (int k = 0; k < 16; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d point = volume.geometry.point_at({double(i), double(j), double(k)});
        volume.voxels.push_back(static_cast<std::int16_t>(std::lround(slope.dot(point))));
      }
    }
  }
  return volume;
}

TEST(Volumes, TurnIndicesIntoPointsAndBack) {
  std::mt19937_64 random{4711};
  std::uniform_real_distribution<double> place{-5, 30};
  const VolumeGeometry geometry = ramp({0, 0, 0}).geometry;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d index{place(random), place(random), place(random)};
    EXPECT_LT((geometry.index_of(geometry.point_at(index)) - index).norm(), 1e-12);
  }
}

TEST(Volumes, AreLinearBetweenVoxelsAndAirOutside) {
  const Eigen::Vector3d slope{20000, -30000, 10000};
  const Volume volume = ramp(slope);
  std::mt19937_64 random{4711};
  std::uniform_real_distribution<double> place{3, 12};
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d point =
        volume.geometry.point_at({place(random), place(random), place(random)});
    EXPECT_NEAR(hounsfield_at(volume, point), slope.dot(point), 0.5);
  }
  EXPECT_EQ(hounsfield_at(volume, {0, 0, 0}), kAirHu);
  EXPECT_EQ(hounsfield_at(volume, volume.geometry.point_at({19, 23, 15.001})), kAirHu);
}

TEST(Volumes, ThatAreNoneAreToldBy) {
  Volume volume = ramp({0, 0, 0});
  EXPECT_FALSE(invalid_input(volume));
  volume.voxels.pop_back();
  EXPECT_EQ(invalid_input(volume), "a volume of 20 x 24 x 16 voxels with 7679 values");
  EXPECT_EQ(invalid_input(Volume{}), "a volume without voxels");
  volume = ramp({0, 0, 0});
  volume.geometry.spacing.y() = NAN;
  EXPECT_EQ(invalid_input(volume), "a volume whose spacing or place is no length");
  volume = ramp({0, 0, 0});
  volume.geometry.direction.col(0) = volume.geometry.direction.col(1);
  EXPECT_EQ(invalid_input(volume), "a volume whose axes are not at right angles");
}

}  // namespace
}  // namespace armature
