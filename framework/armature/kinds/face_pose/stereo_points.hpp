// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/robot/geometry/stereo_camera.hpp"

// How an estimator of face poses makes points, and the face through three of them.
namespace armature ARMATURE_EXPORT {

/// A point of the left camera's frame [m] and its covariance [m2].
struct StereoPoint {
  Eigen::Vector3d at;
  Eigen::Matrix3d covariance;
};

/// The derivative of a point's coordinates by where it is seen: the column in the left image, the
/// column in the right one, the mean row. The disparity d = left column - right column divides all
/// three coordinates; the left column and the row move x and y by baseline / d.
Eigen::Matrix3d derivative_by_pixels(const Eigen::Vector3d& point, double baseline_m,
                                     double disparity);

/// The face with these features: its normal is (mouth to right eye) x (mouth to left eye), which
/// points out of the face (Jiang et al. 2021, (14)), and all covariances follow from theirs.
FacePose face_through(const StereoPoint& left_eye, const StereoPoint& right_eye,
                      const StereoPoint& mouth);

/// The cosine between the normal and the line from the mouth to the camera: 1 seen from the front,
/// 0 from the side.
double facing(const FacePose& face);

}  // namespace armature
