// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/plugin_state.hpp"

namespace armature ARMATURE_EXPORT {

/// By how much lower the right picture shows what the left one shows, as an estimator measures it:
/// nothing in a rectified pair.
struct RowDifference {
  double at_face_px = 0;  // in the middle of the face
  double by_column = 0;   // [px/px] how it grows to the right
  double by_row = 0;      // [px/px] how it grows down
};

/// A face in the left camera's optical frame, [m]. "left" and "right" are sides of the image: the
/// image's left eye is the subject's right one (iBUG 36-41).
struct FacePose {
  Eigen::Vector3d left_eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d right_eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit, out of the face, towards the camera
  Eigen::Matrix3d left_eye_covariance = Eigen::Matrix3d::Zero();   // [m2]
  Eigen::Matrix3d right_eye_covariance = Eigen::Matrix3d::Zero();  // [m2]
  Eigen::Matrix3d mouth_covariance = Eigen::Matrix3d::Zero();      // [m2]
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  // [rad2] across the normal, along 0
  double residual_px = 0;  // by how many rows eyes and mouth differ between the pictures, rms
  std::optional<RowDifference> rows = std::nullopt;  // of an estimator that measures them
};

/// Why there is no pose, for programs: the code of the reason, and of the message.
enum class FaceRefusal : std::uint8_t {
  other,
  no_face,        // none is in both pictures
  bad_input,      // pictures, landmarks or camera are none, or do not belong together
  covered,        // something is before the eyes or the mouth, or they are not to be seen
  brightness,     // the pictures differ in brightness
  not_rectified,  // what is in one row of one picture is in another row of the other
  implausible,    // no face of a person in front of the cameras
  uncertain       // the pictures tell too little
};

struct FacePoseInput {
  ImageView left, right;
  StereoLandmarks landmarks;
  StereoCamera camera;
  /// Finds landmarks again in a picture that the estimator makes of the face; or nullptr.
  LandmarkFinder* finder = nullptr;
};

/// Mouth, eyes and normal of a face from a stereo pair and its landmarks.
class FacePoseEstimator {
 public:
  static constexpr std::string_view kKind = "face_pose";
  using Factory = MadeFromParams<FacePoseEstimator>;

  virtual ~FacePoseEstimator() = default;
  /// The pose, or why the estimate would not be trustworthy, with a FaceRefusal as its code.
  /// `state` is what it remembers of the pictures before, such as where to start. Not const: it may
  /// keep scratch memory, never knowledge. May allocate.
  virtual Expected<FacePose> estimate(const FacePoseInput& input, PluginState& state) = 0;
};

}  // namespace armature
