// SPDX-License-Identifier: Apache-2.0
#include "three_point.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::face_pose::three_point {
namespace {

constexpr double kMinFacing = 0.05;  // cosine between normal and line of sight

const char* name_of(FaceFeature feature) {
  if (feature == FaceFeature::left_eye) return "left eye";
  return feature == FaceFeature::right_eye ? "right eye" : "mouth";
}

/// The derivative of a triangulated point by the column in the left image, the column in the right
/// one and the mean row: the disparity d = left column - right column divides all three
/// coordinates, the left column and the row move x and y by b / d.
Eigen::Matrix3d triangulation_jacobian(const Eigen::Vector3d& point, double baseline,
                                       double disparity) {
  const double step = baseline / disparity;
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = -point / disparity + Eigen::Vector3d{step, 0, 0};
  jacobian.col(1) = point / disparity;
  jacobian.col(2) = Eigen::Vector3d{0, step, 0};
  return jacobian;
}

/// v x ... as a matrix.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace

Expected<std::unique_ptr<FacePoseEstimator>> ThreePoint::make(const Params& params) {
  return std::make_unique<ThreePoint>(Parameters::read(params));
}

// The centres are real numbers: rounding them to pixels, as the paper does, costs 8 degrees at a
// 24 mm baseline.
Expected<ThreePoint::Point> ThreePoint::triangulate(FaceFeature feature,
                                                    const FacePoseInput& input) const {
  const StereoCamera& camera = input.camera;
  const Landmark left = input.landmarks.left.feature(feature);
  const Landmark right = input.landmarks.right.feature(feature);
  if (!left.point.allFinite() || !right.point.allFinite()) {
    return refuse(fmt::format("the {} has no finite pixel", name_of(feature)));
  }
  const double rows = std::abs(left.point.y() - right.point.y());
  if (rows > parameters_.max_epipolar_error) {
    return refuse(fmt::format("the {} differs by {:.1f} rows between the images, more than {:.1f}",
                              name_of(feature), rows, parameters_.max_epipolar_error));
  }
  const double disparity = left.point.x() - right.point.x();
  if (disparity <= 0) {
    return refuse(fmt::format("the {} has a disparity of {:.2f} px, not a positive one",
                              name_of(feature), disparity));
  }
  const Eigen::Vector3d point = camera.triangulate(left.point, right.point);
  if (point.z() < parameters_.min_depth || point.z() > parameters_.max_depth) {
    return refuse(fmt::format("the {} would be {:.3f} m away, outside {} to {} m", name_of(feature),
                              point.z(), parameters_.min_depth, parameters_.max_depth));
  }
  const Eigen::Matrix3d jacobian = triangulation_jacobian(point, camera.baseline_m, disparity);
  const double left_variance = left.sigma * left.sigma, right_variance = right.sigma * right.sigma;
  const Eigen::Vector3d variances{left_variance, right_variance,
                                  0.25 * (left_variance + right_variance)};
  return Point{.at = point, .covariance = jacobian * variances.asDiagonal() * jacobian.transpose()};
}

Expected<FacePose> ThreePoint::estimate(const FacePoseInput& input, PluginState&) {
  for (const FaceLandmarks* face : {&input.landmarks.left, &input.landmarks.right}) {
    const std::size_t count = landmark_count(face->scheme);
    if (face->points.size() != count) {
      return refuse(fmt::format("{} landmarks, and {} has {}", face->points.size(),
                                to_string(face->scheme), count));
    }
    const auto wrong = std::ranges::find_if(face->points, [](const Landmark& landmark) {
      return !(landmark.sigma > 0 && std::isfinite(landmark.sigma));
    });
    if (wrong != face->points.end()) {
      return refuse(fmt::format("a landmark's sigma is {} px, not a positive one", wrong->sigma));
    }
  }
  const auto left_eye = triangulate(FaceFeature::left_eye, input);
  if (!left_eye) return tl::unexpected{left_eye.error()};
  const auto right_eye = triangulate(FaceFeature::right_eye, input);
  if (!right_eye) return tl::unexpected{right_eye.error()};
  const auto mouth = triangulate(FaceFeature::mouth, input);
  if (!mouth) return tl::unexpected{mouth.error()};

  const double eye_distance = (right_eye->at - left_eye->at).norm();
  if (eye_distance < parameters_.min_eye_distance || eye_distance > parameters_.max_eye_distance) {
    return refuse(fmt::format("the eyes would be {:.1f} mm apart, outside {:.0f} to {:.0f} mm",
                              eye_distance * 1e3, parameters_.min_eye_distance * 1e3,
                              parameters_.max_eye_distance * 1e3));
  }

  // (14) is a cross product; this order points out of the face.
  const Eigen::Vector3d to_right = right_eye->at - mouth->at, to_left = left_eye->at - mouth->at;
  const Eigen::Vector3d across = to_right.cross(to_left);
  const Eigen::Vector3d normal = across.normalized();
  const double facing = -normal.dot(mouth->at.normalized());
  if (!(facing > kMinFacing)) {
    return refuse(fmt::format("the face would be seen from {:.0f} degrees aside, or from behind",
                              std::acos(std::clamp(facing, -1.0, 1.0)) * 180 / std::numbers::pi));
  }

  // The normal's derivative by each of the three points.
  const Eigen::Matrix3d unit =
      (Eigen::Matrix3d::Identity() - normal * normal.transpose()) / across.norm();
  const Eigen::Matrix3d by_right = -unit * cross_matrix(to_left);
  const Eigen::Matrix3d by_left = unit * cross_matrix(to_right);
  const Eigen::Matrix3d by_mouth = -by_right - by_left;
  return FacePose{.left_eye = left_eye->at,
                  .right_eye = right_eye->at,
                  .mouth = mouth->at,
                  .normal = normal,
                  .left_eye_covariance = left_eye->covariance,
                  .right_eye_covariance = right_eye->covariance,
                  .mouth_covariance = mouth->covariance,
                  .normal_covariance = by_right * right_eye->covariance * by_right.transpose() +
                                       by_left * left_eye->covariance * by_left.transpose() +
                                       by_mouth * mouth->covariance * by_mouth.transpose()};
}

}  // namespace armature::face_pose::three_point

ARMATURE_PLUGIN(armature::face_pose::three_point::ThreePoint);
