// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/stereo_points.hpp"

#include <Eigen/Geometry>

namespace armature {
namespace {

/// v x ... as a matrix.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace

Eigen::Matrix3d derivative_by_pixels(const Eigen::Vector3d& point, double baseline_m,
                                     double disparity) {
  const double step = baseline_m / disparity;
  Eigen::Matrix3d derivative;
  derivative.col(0) = -point / disparity + Eigen::Vector3d{step, 0, 0};
  derivative.col(1) = point / disparity;
  derivative.col(2) = Eigen::Vector3d{0, step, 0};
  return derivative;
}

FacePose face_through(const StereoPoint& left_eye, const StereoPoint& right_eye,
                      const StereoPoint& mouth) {
  const Eigen::Vector3d to_right = right_eye.at - mouth.at, to_left = left_eye.at - mouth.at;
  const Eigen::Vector3d across = to_right.cross(to_left);
  const Eigen::Vector3d normal = across.normalized();
  // The normal's derivative by each of the three points.
  const Eigen::Matrix3d unit =
      (Eigen::Matrix3d::Identity() - normal * normal.transpose()) / across.norm();
  const Eigen::Matrix3d by_right = -unit * cross_matrix(to_left);
  const Eigen::Matrix3d by_left = unit * cross_matrix(to_right);
  const Eigen::Matrix3d by_mouth = -by_right - by_left;
  return FacePose{.left_eye = left_eye.at,
                  .right_eye = right_eye.at,
                  .mouth = mouth.at,
                  .normal = normal,
                  .left_eye_covariance = left_eye.covariance,
                  .right_eye_covariance = right_eye.covariance,
                  .mouth_covariance = mouth.covariance,
                  .normal_covariance = by_right * right_eye.covariance * by_right.transpose() +
                                       by_left * left_eye.covariance * by_left.transpose() +
                                       by_mouth * mouth.covariance * by_mouth.transpose()};
}

double facing(const FacePose& face) { return -face.normal.dot(face.mouth.normalized()); }

}  // namespace armature
