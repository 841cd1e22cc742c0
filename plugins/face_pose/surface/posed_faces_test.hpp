// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "armature/kinds/face_picture.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/scene/generated_face.hpp"
#include "armature/scene/right_camera.hpp"
#include "armature/scene/scene_renderer.hpp"

// Drawn faces in poses before two cameras, and what an estimator makes of them.
namespace armature::face_pose::surface {

inline const StereoCamera kDefaultRig{
    .width = 1280, .height = 720, .focal_px = 914, .cx = 639.5, .cy = 359.5, .baseline_m = 0.12};
inline const StereoCamera kPapersRig{.width = 1000,
                                     .height = 1000,
                                     .focal_px = 787.4015748,
                                     .cx = 500,
                                     .cy = 500,
                                     .baseline_m = 0.024};

struct Circumstances {
  StereoCamera camera = kDefaultRig;
  scene::Staging staging = {};
  scene::RightCamera right = {};
  double brightness = 1;
  double noise = 2;
  double landmark_error = 1.5;  // [px] standard deviation in each picture, of a whole feature
  double depth = 0.5;           // [m]
  double max_turn_deg = 30;     // [degrees] about the upright and the level axis
  double aside = 0;             // [m] to the right of the left camera's axis
};

/// One face as both cameras see it.
struct PosedFace {
  Picture left, right;
  StereoLandmarks landmarks;
  StereoCamera camera;
  scene::FacePoints truth;  // in the left camera's frame

  FacePoseInput input(LandmarkFinder* finder = nullptr) const {
    return {.left = left.view(),
            .right = right.view(),
            .landmarks = landmarks,
            .camera = camera,
            .finder = finder};
  }
};

/// How far an estimate is off.
struct PoseError {
  double normal_deg, mouth_depth_mm, mouth_mm;
};

inline PoseError error_of(const FacePose& found, const PosedFace& face) {
  const double cosine = std::clamp(found.normal.dot(face.truth.normal()), -1.0, 1.0);
  const Eigen::Vector3d mouth = found.mouth - face.truth.mouth;
  return {.normal_deg = std::acos(cosine) * 180 / std::numbers::pi,
          .mouth_depth_mm = std::abs(mouth.dot(face.truth.mouth.normalized())) * 1e3,
          .mouth_mm = mouth.norm() * 1e3};
}

/// Landmarks of ibug68 at the features, all of one feature with the same error.
inline FaceLandmarks landmarks_at(const std::array<Eigen::Vector2d, 3>& features) {
  FaceLandmarks face;
  face.points.assign(68, {.point = features[2], .sigma = 0.3});
  for (std::size_t i = 36; i <= 41; ++i) face.points[i].point = features[0];
  for (std::size_t i = 42; i <= 47; ++i) face.points[i].point = features[1];
  return face;
}

inline PosedFace posed_face(const Circumstances& how, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> unit{-1, 1};
  std::normal_distribution<double> error{0, how.landmark_error};
  const double turned = how.max_turn_deg * std::numbers::pi / 180;
  const Eigen::Vector3d mouth{how.aside + 0.05 * unit(random), 0.03 + 0.04 * unit(random),
                              how.depth * (1 + 0.1 * unit(random))};
  const double yaw = turned * unit(random), pitch = turned * unit(random);
  const Eigen::Isometry3d left_T_face =
      Eigen::Translation3d{mouth} *
      (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
       Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()} *
       Eigen::AngleAxisd{0.1 * unit(random), Eigen::Vector3d::UnitZ()});
  const scene::Photo photo = scene::generated_face(1 + seed % 5, 0.063);
  scene::SceneRenderer renderer{
      photo, how.staging, {.noise = how.noise, .blur_px = 0.5, .background = 120}, seed};
  const Picture black = Picture::of_one_grey(0, how.camera.width, how.camera.height);
  PosedFace face{.left = black,
                 .right = black,
                 .landmarks = {},
                 .camera = how.camera,
                 .truth = renderer.truth().in(left_T_face)};
  renderer.render(left_T_face, how.camera, how.brightness, 2 * seed, face.left.pixels);
  renderer.render(how.right.right_T_left(how.camera) * left_T_face, how.right.of(how.camera),
                  how.brightness * how.right.gain, 2 * seed + 1, face.right.pixels);
  const auto with_error = [&](const Eigen::Vector2d& pixel) {
    return Eigen::Vector2d{pixel.x() + error(random), pixel.y() + error(random)};
  };
  std::array<Eigen::Vector2d, 3> in_left, in_right;
  const std::array points{face.truth.left_eye, face.truth.right_eye, face.truth.mouth};
  for (std::size_t i = 0; i < points.size(); ++i) {
    in_left[i] = with_error(how.camera.project_left(points[i]));
    in_right[i] = with_error(how.camera.project_right(points[i]));
  }
  face.landmarks = {landmarks_at(in_left), landmarks_at(in_right)};
  return face;
}

/// The value that `share` of all are below.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace armature::face_pose::surface
