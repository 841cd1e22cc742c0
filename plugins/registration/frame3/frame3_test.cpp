// SPDX-License-Identifier: Apache-2.0
#include "frame3.hpp"

#include "armature/kinds/registration/contract.hpp"

namespace armature::registration::frame3 {
namespace {

INSTANTIATE_TEST_SUITE_P(Frame3, RegistrationLaws,
                         testing::Values(RegistrationSubject{
                             "frame3", std::make_shared<Frame3>(Parameters{}), 3}));

const MarkerPairs kTriangle{{{0, 0, 0}, {0.1, 0, 0}, {0.02, 0.08, 0}},
                            {{1, 0, 0}, {1, 0.1, 0}, {0.92, 0.02, 0}}};

TEST(Frame3, TheFirstMarkerAndTheDirectionToTheSecondAreTakenExactly) {
  MarkerPairs noisy = kTriangle;
  noisy.robot[1] += Eigen::Vector3d{0.001, 0.002, -0.001};
  noisy.robot[2] += Eigen::Vector3d{0.002, -0.001, 0.001};
  const auto found = Frame3{Parameters{}}.find(noisy);
  ASSERT_TRUE(found);
  EXPECT_LT(found->residual_m[0], 1e-15);
  const Eigen::Vector3d wanted = (noisy.robot[1] - noisy.robot[0]).normalized();
  EXPECT_LT((found->robot_T_image.linear().col(0) - wanted).norm(), 1e-15);
  EXPECT_GT(found->residual_m[2], 1e-4);
}

TEST(Frame3, RefusesThreeMarkersNearlyOnOneLineInEitherFrame) {
  MarkerPairs flat = kTriangle;
  flat.image[2] = {0.05, 0.001, 0};
  EXPECT_EQ(Frame3{Parameters{}}.find(flat).error().text,
            "markers 1 to 3 lie nearly on one line in the image: condition 86.6, at most 20 "
            "(max_condition)");
  flat = kTriangle;
  flat.robot[2] = {1, 0.05, 0.001};
  EXPECT_EQ(Frame3{Parameters{}}.find(flat).error().text,
            "markers 1 to 3 lie nearly on one line before the robot: condition 86.6, at most 20 "
            "(max_condition)");
}

}  // namespace
}  // namespace armature::registration::frame3
