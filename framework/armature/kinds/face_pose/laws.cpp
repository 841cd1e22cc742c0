// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/laws.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>
#include <utility>

#include "armature/kinds/drawn_face.hpp"

namespace armature {
namespace {

/// The eyes in the face's frame [m].
Eigen::Vector3d left_eye() { return {-0.0315, -0.065, 0}; }
Eigen::Vector3d right_eye() { return {0.0315, -0.065, 0}; }

/// A drawn face as both cameras see it, with exact landmarks: `input` looks at `pictures`.
struct PicturedFace {
  DrawnPair pictures;
  FacePoseInput input;

  explicit PicturedFace(const Eigen::Isometry3d& left_T_face)
      : pictures{drawn_face(left_T_face)}, input{exact_face(kDrawnCamera, left_T_face)} {
    input.left = pictures.left.view();
    input.right = pictures.right.view();
  }
  PicturedFace(const PicturedFace&) = delete;
  PicturedFace& operator=(const PicturedFace&) = delete;
};

std::string text(const Eigen::Vector3d& v) {
  return fmt::format("({}, {}, {})", v.x(), v.y(), v.z());
}

/// The pose by someone who remembers nothing.
Expected<FacePose> estimate(const FacePoseSubject& subject, const FacePoseInput& input) {
  PluginState state;
  return subject.estimator->estimate(input, state);
}

double smallest_eigenvalue(const Eigen::Matrix3d& matrix) {
  return matrix.eigenvalues().real().minCoeff();
}

void expect_covariance(const Eigen::Matrix3d& covariance, std::string_view of, LawCheck& check) {
  const auto claim = [&](bool holds, std::string_view what) {
    check.that(holds, fmt::format("the covariance of the {} {}", of, what));
  };
  const double norm = covariance.norm();
  claim(covariance.allFinite(), "is finite");
  claim((covariance - covariance.transpose()).norm() < 1e-9 * norm,
        "is symmetric to less than 1e-9 of its norm");
  claim(smallest_eigenvalue(covariance) >= -1e-9 * norm,
        "has no eigenvalue below -1e-9 times its norm");
}

void expect_covariances(const FacePose& face, LawCheck& check) {
  const auto point = [&](const Eigen::Matrix3d& covariance, std::string_view of) {
    expect_covariance(covariance, of, check);
    check.that(smallest_eigenvalue(covariance) > 0,
               fmt::format("the covariance of the {} has positive eigenvalues only", of));
  };
  point(face.left_eye_covariance, "left eye");
  point(face.right_eye_covariance, "right eye");
  point(face.mouth_covariance, "mouth");
  const Eigen::Matrix3d& normal = face.normal_covariance;
  expect_covariance(normal, "normal", check);
  check.that(normal.trace() > 0, "the covariance of the normal has a positive trace");
  check.that((normal * face.normal).norm() < 1e-9 * normal.norm(),
             "the covariance of the normal is nothing along the normal, to less than 1e-9 of its "
             "norm");
}

void recovers_pose(const FacePoseSubject& subject, LawCheck& check) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  std::mt19937_64 random{4711};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int i = 0; i < 15; ++i) {
    const Eigen::Isometry3d pose =
        placed(0.1 * unit(random), 0.06 * unit(random), 0.6 + 0.2 * unit(random),
               0.5 * unit(random), 0.5 * unit(random));
    const Eigen::Vector3d mouth = pose.translation(), normal = -pose.linear().col(2);
    check.asks(fmt::format("seed 4711, round {}: the mouth at {} m, the normal {}", i, text(mouth),
                           text(normal)));
    const PicturedFace seen{pose};
    const auto face = estimate(subject, seen.input);
    if (!check.answered(face, "a face with exact landmarks")) return;
    check.at_most((face->mouth - mouth).norm() * 1e3, 0.5, "from the mouth to where it is [mm]");
    check.at_most((face->left_eye - pose * left_eye()).norm() * 1e3, 0.5,
                  "from the left eye to where it is [mm]");
    check.at_most((face->right_eye - pose * right_eye()).norm() * 1e3, 0.5,
                  "from the right eye to where it is [mm]");
    check.at_most(std::acos(std::min(1.0, face->normal.dot(normal))) * kDegrees, 0.3,
                  "from the normal to what it is [degrees]");
    expect_covariances(*face, check);
  }
}

void repeats_bits(const FacePoseSubject& subject, LawCheck& check) {
  const PicturedFace face{placed(0.02, 0.01, 0.5, 0.2, 0.1)}, other{placed(0, 0, 0.7)};
  check.asks("a face, another one, the first one again, each with an empty state");
  const auto first = estimate(subject, face.input);
  static_cast<void>(estimate(subject, other.input));
  const auto second = estimate(subject, face.input);
  if (!check.answered(first, "a face") || !check.answered(second, "the same face")) return;
  check.that(first->mouth == second->mouth, "the same input gives the same mouth");
  check.that(first->normal == second->normal, "the same input gives the same normal");
}

void refuses_no_face(const FacePoseSubject& subject, LawCheck& check) {
  const PicturedFace face{placed(0, 0, 0.5)};
  const auto refused = [&](const std::string& what, auto spoil) {
    FacePoseInput bad = face.input;
    spoil(bad.landmarks.left.points, bad.landmarks.right.points);
    check.asks("a face 0.5 m away; " + what);
    check.refused(estimate(subject, bad), what);
  };
  refused("the landmarks of left and right image exchanged",
          [](auto& left, auto& right) { std::swap(left, right); });
  refused("left landmarks that are not finite", [](auto& left, auto&) {
    for (Landmark& landmark : left) landmark.point.x() = std::nan("");
  });
  refused("all landmarks of an image at one point", [](auto& left, auto& right) {
    for (Landmark& landmark : left) landmark.point = {700, 300};
    for (Landmark& landmark : right) landmark.point = {500, 300};
  });
  refused("no right landmarks", [](auto&, auto& right) { right.clear(); });
  refused("one left landmark too few", [](auto& left, auto&) { left.pop_back(); });
  refused("left sigmas that are not finite", [](auto& left, auto&) {
    for (Landmark& landmark : left) landmark.sigma = std::nan("");
  });
  refused("right sigmas of 0", [](auto&, auto& right) {
    for (Landmark& landmark : right) landmark.sigma = 0;
  });
}

}  // namespace

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
    see(left_eye(), i);
  }
  for (const std::size_t i : landmarks_around(FaceFeature::right_eye, left.scheme)) {
    see(right_eye(), i);
  }
  return input;
}

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<FacePoseSubject>{#Name, says, &function},
std::span<const Law<FacePoseSubject>> face_pose_laws() {
  static constexpr std::array kLaws{ARMATURE_FACE_POSE_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
