// SPDX-License-Identifier: Apache-2.0
#include "affine4.hpp"

#include <Eigen/LU>

#include "armature/kinds/registration/contract.hpp"
#include "armature/kinds/registration/target_error.hpp"

namespace armature::registration::affine4 {
namespace {

INSTANTIATE_TEST_SUITE_P(Affine4, RegistrationLaws,
                         testing::Values(RegistrationSubject{
                             "affine4", std::make_shared<Affine4>(Parameters{}), 4}));

const MarkerPairs kCorner{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}},
                          {{1, 0, 0}, {1, 0.1, 0}, {0.9, 0, 0}, {1, 0, 0.1}}};

TEST(Affine4, TheErrorIsThatOfTheBarycentricWeights) {
  constexpr double kMarkerError = 0.001;
  const Eigen::Vector3d target{0.02, 0.05, 0.07};
  Eigen::Matrix4d corners;
  for (int i = 0; i < 4; ++i) corners.col(i) << kCorner.image[static_cast<std::size_t>(i)], 1;
  const Eigen::Vector4d weights = corners.inverse() * target.homogeneous();
  const auto error = predicted_error(Affine4{Parameters{}}, kCorner, target, kMarkerError);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rms_m, kMarkerError * weights.norm(), 1e-12);
}

TEST(Affine4, RefusesFourMarkersInOnePlane) {
  MarkerPairs flat = kCorner;
  flat.image[3] = {0.1, 0.1, 0.0001};
  flat.robot[3] = {0.9, 0.1, 0.0001};
  EXPECT_EQ(Affine4{Parameters{}}.find(flat).error().text,
            "markers 1 to 4 lie nearly in one plane: condition 3000, at most 20 (max_condition)");
}

TEST(Affine4, RefusesAMapThatNoHeadMakes) {
  MarkerPairs mirrored = kCorner;
  for (Eigen::Vector3d& marker : mirrored.robot) marker.z() = -marker.z();
  EXPECT_EQ(Affine4{Parameters{}}.find(mirrored).error().text.substr(0, 66),
            "the robot's markers 1 to 4 are the mirror image of the image's: is");
  MarkerPairs stretched = kCorner;
  stretched.robot[3].z() = 0.12;
  EXPECT_EQ(Affine4{Parameters{}}.find(stretched).error().text.substr(0, 74),
            "the map would stretch by 1.2000, 1 is a head, 0.1 more or less is allowed ");
}

TEST(Affine4, AFifthMarkerIsOnlyCompared) {
  MarkerPairs five = kCorner;
  five.image.push_back({0.1, 0.1, 0.1});
  five.robot.push_back({0.9, 0.1, 0.105});
  const auto found = Affine4{Parameters{}}.find(five);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->used, (std::vector<bool>{true, true, true, true, false}));
  EXPECT_NEAR(found->residual_m[4], 0.005, 1e-12);
  EXPECT_LT(found->fre_m, 1e-15) << "four markers are always taken exactly";
}

}  // namespace
}  // namespace armature::registration::affine4
