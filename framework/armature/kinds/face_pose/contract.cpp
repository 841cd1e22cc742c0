// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/contract.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <random>
#include <utility>

namespace armature {

FacePoseInput exact_face(const StereoCamera& camera, const Eigen::Isometry3d& left_T_face) {
  FacePoseInput input{.left = {}, .right = {}, .landmarks = {}, .camera = camera};
  FaceLandmarks &left = input.landmarks.left, &right = input.landmarks.right;
  left.points.assign(landmark_count(left.scheme), {.sigma = 0.3});
  right.points = left.points;
  const auto see = [&](const Eigen::Vector3d& on_face, std::size_t i) {
    left.points[i].point = camera.project_left(left_T_face * on_face);
    right.points[i].point = camera.project_right(left_T_face * on_face);
  };
  for (std::size_t i = 0; i < left.points.size(); ++i) see(Eigen::Vector3d::Zero(), i);
  for (const std::size_t i : landmarks_around(FaceFeature::left_eye, left.scheme)) {
    see({-0.0315, -0.065, 0}, i);
  }
  for (const std::size_t i : landmarks_around(FaceFeature::right_eye, left.scheme)) {
    see({0.0315, -0.065, 0}, i);
  }
  return input;
}

Eigen::Isometry3d FacePoseLaws::placed(const Eigen::Vector3d& position, double yaw, double pitch) {
  return Eigen::Translation3d{position} * (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
                                           Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()});
}

Expected<FacePose> FacePoseLaws::estimate(const FacePoseInput& input) {
  PluginState state;
  return estimator().estimate(input, state);
}

void FacePoseLaws::expect_covariance(const Eigen::Matrix3d& covariance) {
  EXPECT_TRUE(covariance.allFinite());
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
  EXPECT_GE(covariance.eigenvalues().real().minCoeff(), -1e-9 * covariance.norm());
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
    const auto face = estimate(exact_face(camera_, pose));
    ASSERT_TRUE(face) << face.error().text;
    EXPECT_LT((face->mouth - pose.translation()).norm(), 1e-10);
    EXPECT_LT((face->left_eye - pose * Eigen::Vector3d{-0.0315, -0.065, 0}).norm(), 1e-10);
    EXPECT_LT((face->right_eye - pose * Eigen::Vector3d{0.0315, -0.065, 0}).norm(), 1e-10);
    EXPECT_LT((face->normal + pose.linear().col(2)).norm(), 1e-9);
    for (const Eigen::Matrix3d& covariance :
         {face->left_eye_covariance, face->right_eye_covariance, face->mouth_covariance}) {
      expect_covariance(covariance);
      EXPECT_GT(covariance.eigenvalues().real().minCoeff(), 0);
    }
    expect_covariance(face->normal_covariance);
    EXPECT_GT(face->normal_covariance.trace(), 0);
    EXPECT_LT((face->normal_covariance * face->normal).norm(),
              1e-9 * face->normal_covariance.norm());
  }
}

TEST_P(FacePoseLaws, GivesTheSameBitsForTheSameInput) {
  const FacePoseInput input = exact_face(camera_, placed({0.02, 0.01, 0.5}, 0.2, 0.1));
  const auto first = estimate(input);
  static_cast<void>(estimate(exact_face(camera_, placed({0, 0, 0.7}, 0, 0))));
  const auto second = estimate(input);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->mouth, second->mouth);
  EXPECT_EQ(first->normal, second->normal);
}

TEST_P(FacePoseLaws, RefusesLandmarksThatAreNoFace) {
  const Eigen::Isometry3d pose = placed({0, 0, 0.5}, 0, 0);
  FacePoseInput swapped = exact_face(camera_, pose);
  std::swap(swapped.landmarks.left, swapped.landmarks.right);
  FacePoseInput not_finite = exact_face(camera_, pose);
  for (auto& point : not_finite.landmarks.left.points) point.point.x() = std::nan("");
  FacePoseInput one_point = exact_face(camera_, pose);
  for (auto& landmark : one_point.landmarks.left.points) landmark.point = {700, 300};
  for (auto& landmark : one_point.landmarks.right.points) landmark.point = {500, 300};
  FacePoseInput none = exact_face(camera_, pose);
  none.landmarks.right.points.clear();
  FacePoseInput too_few = exact_face(camera_, pose);
  too_few.landmarks.left.points.pop_back();
  FacePoseInput no_sigma = exact_face(camera_, pose);
  for (auto& landmark : no_sigma.landmarks.left.points) landmark.sigma = std::nan("");
  FacePoseInput certain = exact_face(camera_, pose);
  for (auto& landmark : certain.landmarks.right.points) landmark.sigma = 0;
  for (const auto& bad : {swapped, not_finite, one_point, none, too_few, no_sigma, certain}) {
    const auto refused = estimate(bad);
    ASSERT_FALSE(refused);
    EXPECT_FALSE(refused.error().text.empty());
  }
}
}  // namespace armature
