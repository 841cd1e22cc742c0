// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/contract.hpp"

#include <algorithm>
#include <random>
#include <utility>

namespace armature {

FacePoseInput exact_face(const StereoCamera& camera, const Eigen::Isometry3d& left_T_face) {
  FacePoseInput input{.left = {}, .right = {}, .landmarks = {}, .camera = camera};
  for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
    Eigen::Vector3d on_face = Eigen::Vector3d::Zero();
    if (i >= 36 && i <= 41) on_face = {-0.0315, -0.065, 0};
    if (i >= 42 && i <= 47) on_face = {0.0315, -0.065, 0};
    input.landmarks.left.points[i] = camera.project_left(left_T_face * on_face);
    input.landmarks.right.points[i] = camera.project_right(left_T_face * on_face);
  }
  return input;
}

Eigen::Isometry3d FacePoseLaws::placed(const Eigen::Vector3d& position, double yaw, double pitch) {
  return Eigen::Translation3d{position} * (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
                                           Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()});
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FacePoseLaws);

TEST_P(FacePoseLaws, RecoversTheExactPoseFromExactLandmarks) {
  std::mt19937_64 random{4711};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const Eigen::Isometry3d pose =
        placed({0.1 * unit(random), 0.1 * unit(random), 0.6 + 0.3 * unit(random)},
               0.8 * unit(random), 0.8 * unit(random));
    const auto face = estimator().estimate(exact_face(camera_, pose));
    ASSERT_TRUE(face) << face.error().text;
    EXPECT_LT((face->mouth - pose.translation()).norm(), 1e-10);
    EXPECT_LT((face->left_eye - pose * Eigen::Vector3d{-0.0315, -0.065, 0}).norm(), 1e-10);
    EXPECT_LT((face->right_eye - pose * Eigen::Vector3d{0.0315, -0.065, 0}).norm(), 1e-10);
    EXPECT_LT((face->normal + pose.linear().col(2)).norm(), 1e-9);
    EXPECT_GT(face->mouth_sigma_m, 0);
    EXPECT_GT(face->normal_sigma_rad, 0);
  }
}

TEST_P(FacePoseLaws, GivesTheSameBitsForTheSameInput) {
  const FacePoseInput input = exact_face(camera_, placed({0.02, 0.01, 0.5}, 0.2, 0.1));
  const auto first = estimator().estimate(input);
  static_cast<void>(estimator().estimate(exact_face(camera_, placed({0, 0, 0.7}, 0, 0))));
  const auto second = estimator().estimate(input);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->mouth, second->mouth);
  EXPECT_EQ(first->normal, second->normal);
}

TEST_P(FacePoseLaws, RefusesLandmarksThatAreNoFace) {
  const Eigen::Isometry3d pose = placed({0, 0, 0.5}, 0, 0);
  FacePoseInput swapped = exact_face(camera_, pose);
  std::swap(swapped.landmarks.left, swapped.landmarks.right);
  FacePoseInput not_finite = exact_face(camera_, pose);
  for (auto& point : not_finite.landmarks.left.points) point.x() = std::nan("");
  FacePoseInput one_point = exact_face(camera_, pose);
  one_point.landmarks.left.points.fill({700, 300});
  one_point.landmarks.right.points.fill({500, 300});
  for (const auto& bad : {swapped, not_finite, one_point}) {
    const auto refused = estimator().estimate(bad);
    ASSERT_FALSE(refused);
    EXPECT_FALSE(refused.error().text.empty());
  }
}
}  // namespace armature
