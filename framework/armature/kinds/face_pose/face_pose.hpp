// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/stereo_camera.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// A face in the left camera's optical frame, [m]. "left" and "right" are sides of the image: the
/// image's left eye is the subject's right one (iBUG 36-41).
struct FacePose {
  Eigen::Vector3d left_eye, right_eye, mouth;
  Eigen::Vector3d normal;    // unit, out of the face, towards the camera
  double mouth_sigma_m = 0;  // 1-sigma of the mouth position along the line of sight
  double normal_sigma_rad = 0;
};

struct FacePoseInput {
  ImageView left, right;
  StereoLandmarks landmarks;
  StereoCamera camera;
};

/// Mouth, eyes and normal of a face from a stereo pair and its landmarks.
class FacePoseEstimator {
 public:
  static constexpr std::string_view kKind = "face_pose";
  static constexpr int kKindVersion = 1;
  using Factory = MadeFromParams<FacePoseEstimator>;

  virtual ~FacePoseEstimator() = default;
  /// The pose, or why the estimate would not be trustworthy. May allocate.
  virtual Expected<FacePose> estimate(const FacePoseInput& input) = 0;
};

}  // namespace armature
