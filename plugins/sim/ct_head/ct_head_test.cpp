// SPDX-License-Identifier: Apache-2.0
// The scan of a head: everything is where the anatomy says.
#include "ct_head.hpp"

#include <gtest/gtest.h>

namespace armature::sim::ct_head {
namespace {

Anatomy anatomy() {
  return {.markers = {{0.0886, 0, 0.0156}, {-0.0151, 0.0856, 0.0233}, {0.0219, 0.0080, 0.0869}},
          .lesion = {0.010, 0.005, 0.012},
          .vessels = {{"vessel", {0.020, 0.035, 0.040}, {0.040, 0.020, 0.035}, 0.005}}};
}

/// Coarse, which is enough to look at points far from surfaces.
Parameters coarse() { return {.voxel = {0.002, 0.002, 0.002}, .noise = 0}; }

TEST(CtHeads, ShowEveryThingWhereItIs) {
  const Volume volume = scan(anatomy(), coarse(), 1).value();
  EXPECT_FALSE(invalid_input(volume));
  for (const Eigen::Vector3d& marker : anatomy().markers) {
    EXPECT_EQ(hounsfield_at(volume, marker), 2500);
  }
  EXPECT_EQ(hounsfield_at(volume, {0.010, 0.005, 0.012}), 100);    // lesion
  EXPECT_EQ(hounsfield_at(volume, {0.030, 0.0275, 0.0375}), 250);  // vessel
  EXPECT_EQ(hounsfield_at(volume, {-0.03, -0.02, -0.04}), 35);     // brain
  EXPECT_EQ(hounsfield_at(volume, {0, 0, -0.0745}), 1000);         // skull
  EXPECT_EQ(hounsfield_at(volume, {0, 0, -0.0870}), kAirHu);
}

TEST(CtHeads, NoiseFollowsTheSeed) {
  Parameters noisy = coarse();
  noisy.noise = 10;
  const Volume first = scan(anatomy(), noisy, 1).value();
  EXPECT_EQ(first.voxels, scan(anatomy(), noisy, 1)->voxels);
  EXPECT_NE(first.voxels, scan(anatomy(), noisy, 2)->voxels);
}

TEST(CtHeads, LoseMarkersFromTheEndOfTheList) {
  Parameters parameters = coarse();
  parameters.lost_markers = 1;
  const Volume volume = scan(anatomy(), parameters, 1).value();
  EXPECT_EQ(hounsfield_at(volume, anatomy().markers[1]), 2500);
  EXPECT_EQ(hounsfield_at(volume, anatomy().markers[2]), kAirHu);
}

TEST(CtHeads, MirroredShowEveryThingAtTheOtherSide) {
  Parameters parameters = coarse();
  parameters.mirrored = true;
  const Volume volume = scan(anatomy(), parameters, 1).value();
  for (const Eigen::Vector3d& marker : anatomy().markers) {
    EXPECT_EQ(hounsfield_at(volume, {-marker.x(), marker.y(), marker.z()}), 2500);
  }
}

TEST(CtHeads, RefuseWhatIsNoHead) {
  Anatomy far = anatomy(), unknown = anatomy(), negative = anatomy();
  far.markers[0].x() = 0.3;
  unknown.lesion.y() = NAN;
  negative.vessels[0].radius_m = -1;
  for (const Anatomy& wrong : {far, unknown}) {
    EXPECT_EQ(scan(wrong, coarse(), 1).error().text,
              "a marker, the lesion or a vessel is not within 250 mm of the middle of the head");
  }
  EXPECT_FALSE(scan(negative, coarse(), 1));
}

}  // namespace
}  // namespace armature::sim::ct_head
