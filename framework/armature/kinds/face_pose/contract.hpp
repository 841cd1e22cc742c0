// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <ostream>
#include <string>

#include "armature/kinds/face_pose/face_pose.hpp"

// The laws that every `face_pose` plugin that works from landmarks keeps. In the plugin's test, in
// one source file:
//
//   INSTANTIATE_TEST_SUITE_P(ThreePoint, FacePoseLaws, testing::Values(...));
namespace armature {

struct FacePoseSubject {
  std::string name;
  std::shared_ptr<FacePoseEstimator> estimator;

  friend void PrintTo(const FacePoseSubject& subject, std::ostream* out) { *out << subject.name; }
};

/// Landmarks of a flat face with eyes 63 mm apart, 65 mm above the mouth, without error, though a
/// sigma of 0.3 px is stated. The face's
/// frame: origin at the mouth, x to the image's right, y down, z into the face. All landmarks of a
/// feature lie at its centre; the others at the mouth.
FacePoseInput exact_face(const StereoCamera& camera, const Eigen::Isometry3d& left_T_face);

class FacePoseLaws : public testing::TestWithParam<FacePoseSubject> {
 protected:
  FacePoseEstimator& estimator() { return *GetParam().estimator; }
  /// The pose by someone who remembers nothing.
  Expected<FacePose> estimate(const FacePoseInput& input);
  static void expect_covariance(const Eigen::Matrix3d& covariance);
  static Eigen::Isometry3d placed(const Eigen::Vector3d& position, double yaw, double pitch);
  const StereoCamera camera_{
      .width = 1280, .height = 720, .focal_px = 914, .cu = 639.5, .cv = 359.5, .baseline_m = 0.12};
};

}  // namespace armature
