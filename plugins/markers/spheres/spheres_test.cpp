// SPDX-License-Identifier: Apache-2.0
#include "spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "armature/kinds/markers/contract.hpp"
#include "armature/kinds/markers/marked_phantom.hpp"

namespace armature::markers::spheres {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Spheres, MarkerLaws,
    testing::Values(MarkerSubject{"five_mm", std::make_shared<Spheres>(Parameters{})},
                    MarkerSubject{"four_mm",
                                  std::make_shared<Spheres>(Parameters{.radius = 0.004})}),
    testing::PrintToStringParamName());

/// Of the sixty markers of ten heads.
struct Worst {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  // in voxels
  double sigmas = 0;                                // in sigmas of its own
};

Worst worst_of(const Eigen::Vector3d& spacing, double noise) {
  Worst worst;
  for (std::uint64_t seed = 101; seed <= 110; ++seed) {
    const auto phantom = marked_phantom(0.005, spacing, noise, seed);
    const auto found = Spheres{Parameters{}}.find(phantom.scan()).value();
    EXPECT_EQ(found.size(), 6u) << "seed " << seed;
    for (const FoundMarker& marker : found) {
      const auto truth = *std::ranges::min_element(
          phantom.markers, {}, [&](const auto& place) { return (place - marker.centre).norm(); });
      const Eigen::Vector3d error = marker.centre - truth;
      worst.error = worst.error.cwiseMax(error.cwiseQuotient(spacing).cwiseAbs());
      worst.sigmas = std::max(worst.sigmas, error.norm() / marker.sigma);
    }
  }
  return worst;
}

TEST(Spheres, AreFoundToATenthOfAVoxelWhateverItsShape) {
  for (const Eigen::Vector3d& spacing :
       {Eigen::Vector3d{0.0008, 0.0008, 0.001}, Eigen::Vector3d{0.001, 0.001, 0.001},
        Eigen::Vector3d{0.0007, 0.0007, 0.002}, Eigen::Vector3d{0.001, 0.001, 0.002}}) {
    const Worst worst = worst_of(spacing, 20);
    const Eigen::Vector3d mm = 1e3 * spacing;
    std::printf("voxels of %g x %g x %g mm: off by at most %.3f, %.3f, %.3f voxels, %.1f sigma\n",
                mm.x(), mm.y(), mm.z(), worst.error.x(), worst.error.y(), worst.error.z(),
                worst.sigmas);
    EXPECT_LT(worst.error.maxCoeff(), 0.1);
    EXPECT_LT(worst.sigmas, 4);
  }
}

TEST(Spheres, AThresholdBelowTheBonesDensityFindsNoMarkerThatTouchesIt) {
  const auto phantom = marked_phantom(0.005, Eigen::Vector3d::Constant(0.001), 0, 1);
  EXPECT_LT(Spheres{Parameters{.threshold = -500}}.find(phantom.scan())->size(), 6u);
}

}  // namespace
}  // namespace armature::markers::spheres
