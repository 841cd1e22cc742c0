// SPDX-License-Identifier: Apache-2.0
#include "three_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "armature/kinds/face_pose/stereo_points.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature::face_pose::three_point {
namespace {

constexpr double kMinFacing = 0.05;  // cosine between normal and line of sight

/// [px] of eyes and mouth, rms.
double row_difference(const StereoLandmarks& landmarks) {
  constexpr std::array kFeatures{FaceFeature::left_eye, FaceFeature::right_eye, FaceFeature::mouth};
  double squares = 0;
  for (const FaceFeature feature : kFeatures) {
    const double rows =
        landmarks.left.feature(feature).point.y() - landmarks.right.feature(feature).point.y();
    squares += rows * rows;
  }
  return std::sqrt(squares / kFeatures.size());
}

const char* name_of(FaceFeature feature) {
  if (feature == FaceFeature::left_eye) return "left eye";
  return feature == FaceFeature::right_eye ? "right eye" : "mouth";
}

}  // namespace

Expected<std::unique_ptr<FacePoseEstimator>> ThreePoint::make(const Params& params) {
  return std::make_unique<ThreePoint>(Parameters::read(params));
}

// The centres are real numbers: rounding them to pixels, as the paper does, costs 8 degrees at a
// 24 mm baseline.
Expected<StereoPoint> ThreePoint::triangulate(FaceFeature feature,
                                              const FacePoseInput& input) const {
  const StereoCamera& camera = input.camera;
  const Landmark left = input.landmarks.left.feature(feature);
  const Landmark right = input.landmarks.right.feature(feature);
  const double rows = std::abs(left.point.y() - right.point.y());
  if (rows > parameters_.max_epipolar_error) {
    return refuse(FaceRefusal::not_rectified,
                  fmt::format("the {} differs by {:.1f} rows between the images, more than {:.1f}",
                              name_of(feature), rows, parameters_.max_epipolar_error));
  }
  const double disparity = left.point.x() - right.point.x();
  if (disparity <= 0) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the {} has a disparity of {:.2f} px, not a positive one: are the "
                              "left and the right camera exchanged?",
                              name_of(feature), disparity));
  }
  const Eigen::Vector3d point = camera.triangulate(left.point, right.point);
  if (point.z() < parameters_.min_depth || point.z() > parameters_.max_depth) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the {} would be {:.3f} m away, outside {} to {} m", name_of(feature),
                              point.z(), parameters_.min_depth, parameters_.max_depth));
  }
  const Eigen::Matrix3d by_pixels = derivative_by_pixels(point, camera.baseline_m, disparity);
  const double left_variance = left.sigma * left.sigma, right_variance = right.sigma * right.sigma;
  const Eigen::Vector3d variances{left_variance, right_variance,
                                  0.25 * (left_variance + right_variance)};
  return StereoPoint{.at = point,
                     .covariance = by_pixels * variances.asDiagonal() * by_pixels.transpose()};
}

Expected<FacePose> ThreePoint::estimate(const FacePoseInput& input, PluginState&) {
  for (const FaceLandmarks* face : {&input.landmarks.left, &input.landmarks.right}) {
    if (auto wrong = invalid_input(*face)) return refuse(FaceRefusal::bad_input, *wrong);
  }
  const auto left_eye = triangulate(FaceFeature::left_eye, input);
  if (!left_eye) return tl::unexpected{left_eye.error()};
  const auto right_eye = triangulate(FaceFeature::right_eye, input);
  if (!right_eye) return tl::unexpected{right_eye.error()};
  const auto mouth = triangulate(FaceFeature::mouth, input);
  if (!mouth) return tl::unexpected{mouth.error()};

  const double eye_distance = (right_eye->at - left_eye->at).norm();
  if (eye_distance < parameters_.min_eye_distance || eye_distance > parameters_.max_eye_distance) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the eyes would be {:.1f} mm apart, outside {:.0f} to {:.0f} mm",
                              eye_distance * 1e3, parameters_.min_eye_distance * 1e3,
                              parameters_.max_eye_distance * 1e3));
  }

  FacePose face = face_through(*left_eye, *right_eye, *mouth);
  if (const double seen = facing(face); !(seen > kMinFacing)) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the face would be seen from {:.0f} degrees aside, or from behind",
                              std::acos(std::clamp(seen, -1.0, 1.0)) * 180 / std::numbers::pi));
  }
  face.residual_px = row_difference(input.landmarks);
  return face;
}

}  // namespace armature::face_pose::three_point

ARMATURE_PLUGIN(armature::face_pose::three_point::ThreePoint);
