// SPDX-License-Identifier: Apache-2.0
#include "three_point.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "armature/runtime/plugin.hpp"

namespace armature::face_pose::three_point {
namespace {

// iBUG 300-W, 0-based. The paper counts from 1: 37-42, 43-48 and 61, 63, 65, 67.
constexpr std::array kLeftEye{36, 37, 38, 39, 40, 41};
constexpr std::array kRightEye{42, 43, 44, 45, 46, 47};
constexpr std::array kMouth{60, 62, 64, 66};

constexpr double kLeastNormalFacing = 0.05;  // cosine between normal and line of sight

// A real number: rounding it to a pixel, as the paper does, costs 8 degrees at a 24 mm baseline.
Eigen::Vector2d mean(const FaceLandmarks& landmarks, std::span<const int> indices) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const int i : indices) sum += landmarks.points[static_cast<std::size_t>(i)];
  return sum / static_cast<double>(indices.size());
}

}  // namespace

Expected<std::unique_ptr<FacePoseEstimator>> ThreePoint::make(const Params& params) {
  return std::make_unique<ThreePoint>(Parameters::read(params));
}

Expected<Eigen::Vector3d> ThreePoint::triangulate(const char* feature, const StereoCamera& camera,
                                                  const Eigen::Vector2d& left,
                                                  const Eigen::Vector2d& right) const {
  if (!left.allFinite() || !right.allFinite()) {
    return refuse(fmt::format("the {} has no finite pixel", feature));
  }
  const double rows = std::abs(left.y() - right.y());
  if (rows > parameters_.most_row_mismatch) {
    return refuse(fmt::format("the {} differs by {:.1f} rows between the images, more than {:.1f}",
                              feature, rows, parameters_.most_row_mismatch));
  }
  const double disparity = left.x() - right.x();
  if (disparity <= 0) {
    return refuse(
        fmt::format("the {} has a disparity of {:.2f} px, not a positive one", feature, disparity));
  }
  const Eigen::Vector3d point = camera.triangulate(left, right);
  if (point.z() < parameters_.nearest || point.z() > parameters_.farthest) {
    return refuse(fmt::format("the {} would be {:.3f} m away, outside {} to {} m", feature,
                              point.z(), parameters_.nearest, parameters_.farthest));
  }
  return point;
}

Expected<FacePose> ThreePoint::estimate(const FacePoseInput& input) {
  const FaceLandmarks &left = input.landmarks.left, &right = input.landmarks.right;
  const auto left_eye =
      triangulate("left eye", input.camera, mean(left, kLeftEye), mean(right, kLeftEye));
  if (!left_eye) return tl::unexpected{left_eye.error()};
  const auto right_eye =
      triangulate("right eye", input.camera, mean(left, kRightEye), mean(right, kRightEye));
  if (!right_eye) return tl::unexpected{right_eye.error()};
  const auto mouth = triangulate("mouth", input.camera, mean(left, kMouth), mean(right, kMouth));
  if (!mouth) return tl::unexpected{mouth.error()};

  const double eye_distance = (*right_eye - *left_eye).norm();
  if (eye_distance < parameters_.least_eye_distance ||
      eye_distance > parameters_.most_eye_distance) {
    return refuse(fmt::format("the eyes would be {:.1f} mm apart, outside {:.0f} to {:.0f} mm",
                              eye_distance * 1e3, parameters_.least_eye_distance * 1e3,
                              parameters_.most_eye_distance * 1e3));
  }

  // (14) is a cross product; this order points out of the face.
  const Eigen::Vector3d across = (*right_eye - *mouth).cross(*left_eye - *mouth);
  const double double_area = across.norm();
  const Eigen::Vector3d normal = across / double_area;
  const double facing = -normal.dot(mouth->normalized());
  if (!(facing > kLeastNormalFacing)) {
    return refuse(fmt::format("the face would be seen from {:.0f} degrees aside, or from behind",
                              std::acos(std::clamp(facing, -1.0, 1.0)) * 180 / std::numbers::pi));
  }

  // dz = z^2 / (f b) dd, and the disparity of two independent features has sqrt(2) of their sigma.
  // The normal turns by the depth error over the lever between eyes and mouth.
  const double depth_sigma = std::numbers::sqrt2 * parameters_.landmark_sigma * mouth->z() *
                             mouth->z() / (input.camera.focal_px * input.camera.baseline_m);
  const double lever = double_area / eye_distance;
  return FacePose{.left_eye = *left_eye,
                  .right_eye = *right_eye,
                  .mouth = *mouth,
                  .normal = normal,
                  .mouth_sigma_m = depth_sigma,
                  .normal_sigma_rad = depth_sigma * std::hypot(std::numbers::sqrt2 / eye_distance,
                                                               std::sqrt(1.5) / lever)};
}

}  // namespace armature::face_pose::three_point

ARMATURE_PLUGIN(armature::face_pose::three_point::ThreePoint);
