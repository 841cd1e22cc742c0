// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/connected_parts.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

const VolumeGeometry kGrid{.size = {5, 4, 3}};

std::size_t at(int i, int j, int k) { return static_cast<std::size_t>((k * 4 + j) * 5 + i); }

VoxelMask mask_of(std::initializer_list<std::size_t> voxels) {
  VoxelMask mask(60, 0);
  for (const std::size_t voxel : voxels) mask[voxel] = 1;
  return mask;
}

TEST(ConnectedParts, HangTogetherByFacesAndNotByEdgesOrAroundTheBorder) {
  const auto mask = mask_of({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1),  // one of four
                             at(2, 2, 1),                                         // by an edge
                             at(4, 0, 2)});  // the next in memory is at(0, 1, 2)
  const auto parts = connected_parts(mask, kGrid, 1, 100);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].size(), 4u);
  EXPECT_EQ(centroid(parts[0]), (Eigen::Vector3d{0.75, 0.5, 0.25}));
  EXPECT_EQ(connected_parts(mask, kGrid, 2, 100).size(), 1u);
  EXPECT_EQ(connected_parts(mask, kGrid, 1, 3).size(), 2u);
}

TEST(ConnectedParts, GrowByCubesAndStayInside) {
  const auto grown = dilated(mask_of({at(0, 1, 1)}), kGrid, 1);
  EXPECT_EQ(std::count(grown.begin(), grown.end(), 1), 2 * 3 * 3);
  EXPECT_EQ(grown[at(1, 2, 2)], 1);
  EXPECT_EQ(grown[at(2, 1, 1)], 0);
  const auto twice = dilated(mask_of({at(0, 1, 1)}), kGrid, 2);
  EXPECT_EQ(std::count(twice.begin(), twice.end(), 1), 3 * 4 * 3);
}

TEST(ConnectedParts, OfAWindowAreAboveItsLowEndAndUpToItsHighOne) {
  const Volume volume{{.size = {4, 1, 1}}, {99, 100, 101, 201}};
  EXPECT_EQ(voxels_between(volume, 99, 101), (VoxelMask{0, 1, 1, 0}));
}

}  // namespace
}  // namespace armature
