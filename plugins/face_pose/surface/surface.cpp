// SPDX-License-Identifier: Apache-2.0
#include "surface.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "armature/runtime/plugins/plugin.hpp"
#include "feature_plane.hpp"
#include "frontal_looks.hpp"
#include "guards.hpp"

namespace armature::face_pose::surface {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kDisparityFloor = 0.01;  // [px] what interpolation between pixels leaves
constexpr double kRelief = 4;             // standard deviations: more is no noise

/// The plane of the last pair, which is where the next one starts: its disparity at pixel (0, 0)
/// [px] and how it grows with the column and the row.
struct Memory {
  static constexpr auto kLayout = layout_id("face_pose/surface", 1);
  double at_origin, by_column, by_row;
};

Features features_of(const FaceLandmarks& face) {
  return {face.feature(FaceFeature::left_eye).point, face.feature(FaceFeature::right_eye).point,
          face.feature(FaceFeature::mouth).point};
}

/// [px] of eyes and mouth, rms.
double row_difference(const Alignment& aligned, const Features& features) {
  double squares = 0;
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    const Vector2d at = aligned.surface.local(features[i]);
    const double rows = aligned.rows.dot(Vector3d{1, at.x(), at.y()});
    squares += rows * rows;
  }
  return std::sqrt(squares / kFaceFeatures.size());
}

/// The plane through the features' own disparities.
DisparitySurface plane_of(const Features& left, const Features& right) {
  Vector3d disparities;
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    disparities[static_cast<Eigen::Index>(i)] = left[i].x() - right[i].x();
  }
  return plane_through(left, disparities);
}

}  // namespace

Expected<std::unique_ptr<FacePoseEstimator>> Surface::make(const Params& params) {
  return std::make_unique<Surface>(Parameters::read(params));
}

Expected<FacePose> Surface::estimate(const FacePoseInput& input, PluginState& state) {
  if (auto sound = input_is_sound(input); !sound) return tl::unexpected{sound.error()};
  fit_.look_at(input.left, input.right);
  Located located{.at = features_of(input.landmarks.left), .sigma = {}, .own = {}};
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    located.sigma[i] = input.landmarks.left.feature(kFaceFeatures[i].which).sigma;
  }
  const auto starts = starts_of(located.at, features_of(input.landmarks.right), state);
  if (!starts) return tl::unexpected{starts.error()};
  Alignment aligned;
  auto face = look(input, *starts, aligned, located);
  // Landmarks of a turned face may be so far off that the frontal view they lead to is a poor one.
  // What was found in it leads to a good one.
  if (!face && located.is_unsettled) {
    located.is_last_look = true;
    face = look(input, {aligned.surface.tangent(aligned.surface.middle)}, aligned, located);
  }
  if (!face) return face;
  const DisparitySurface plane = aligned.surface.tangent(aligned.surface.middle);
  state.set(Memory{.at_origin = plane.at(Vector2d::Zero()),
                   .by_column = plane.c[1] / plane.reach,
                   .by_row = plane.c[2] / plane.reach});
  return face;
}

Expected<std::vector<DisparitySurface>> Surface::starts_of(const Features& left,
                                                           const Features& right,
                                                           const PluginState& state) {
  std::vector starts{plane_of(left, right)};
  if (!starts.front().c.allFinite() || !(starts.front().c[0] > 0)) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the face has a disparity of {:.2f} px, not a positive one: are the "
                              "left and the right camera exchanged?",
                              starts.front().c[0]));
  }
  if (const Memory* last = state.get<Memory>()) {
    DisparitySurface plane{.middle = starts.front().middle, .reach = starts.front().reach};
    const Vector2d slope{last->by_column, last->by_row};
    plane.c[0] = last->at_origin + slope.dot(plane.middle);
    plane.c.segment<2>(1) = slope * plane.reach;
    starts.push_back(plane);
  }
  return starts;
}

/// One look at the face, starting with the features that are `located`, which become those of the
/// frontal view.
Expected<FacePose> Surface::look(const FacePoseInput& input,
                                 const std::vector<DisparitySurface>& starts, Alignment& aligned,
                                 Located& located) {
  located.is_unsettled = false;
  if (auto inside = face_is_in_picture(located.at, input.camera); !inside) {
    return tl::unexpected{inside.error()};
  }
  const auto fitted = fit_.align(located.at, starts);
  if (!fitted) return tl::unexpected{fitted.error()};
  aligned = *fitted;
  for (const auto& sound : {pictures_agree(aligned, input.camera, parameters_),
                            see_features(aligned, input.camera, located),
                            pictures_are_rectified(aligned, input.camera, parameters_)}) {
    if (!sound) return tl::unexpected{sound.error()};
  }
  if (input.finder) {
    if (auto found = find_again(input, aligned, located); !found) {
      return tl::unexpected{found.error()};
    }
  }
  const FacePose face = pose(aligned, input.camera, located);
  if (auto sound = face_is_believable(face, parameters_); !sound)
    return tl::unexpected{sound.error()};
  return face;
}

Expected<void> Surface::find_again(const FacePoseInput& input, const Alignment& aligned,
                                   Located& located) {
  view_.render(input.left, input.right, aligned, located.at, input.camera);
  const auto seen =
      look_at_features(view_, *input.finder, parameters_.max_unsteadiness, located.is_last_look);
  if (!seen) return tl::unexpected{seen.error()};
  const Features before = located.at;
  std::array<Vector2d, 3> in_left;
  std::string unsettled;
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    const SeenFeature& feature = (*seen)[i];
    in_left[i] = view_.in_left(feature.at);
    const double px_per_px = (view_.in_left(feature.at + Vector2d{1, 0}) - in_left[i]).norm();
    located.sigma[i] = feature.sigma * px_per_px;
    const double moved = (in_left[i] - before[i]).norm() / before.across().norm();
    if (!(feature.moved <= parameters_.max_unsteadiness)) {
      unsettled = fmt::format(
          "the {} is not to be seen: sought from another box it seems to be "
          "elsewhere, by {:.0f} % of the eyes' distance",
          kFaceFeatures[i].name, 100 * feature.moved);
    } else if (!(moved <= parameters_.max_disagreement)) {
      unsettled = fmt::format(
          "the {} is elsewhere in a frontal view, by {:.0f} % of the eyes' "
          "distance",
          kFaceFeatures[i].name, 100 * moved);
    }
  }
  located.at = {in_left[0], in_left[1], in_left[2]};
  located.is_unsettled = !unsettled.empty();
  if (located.is_unsettled) return refuse(FaceRefusal::covered, unsettled);
  return {};
}

Expected<void> Surface::see_features(const Alignment& aligned, const StereoCamera& camera,
                                     Located& located) {
  std::array<DisparitySurface, 3> around;
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    const auto& [which, name, area] = kFaceFeatures[i];
    Alignment& own = located.own[i] = aligned;
    if (!fit_.align_feature(area, own)) {
      return refuse(
          FaceRefusal::uncertain,
          fmt::format("too little of the {} is in both pictures and not over-exposed", name));
    }
    auto seen = feature_is_uncovered(name, located.at[i], own, aligned, camera, parameters_);
    if (!seen) return seen;
    around[i] = own.surface;
    located.relief[i] = come_near(area, located.at[i], own);
  }
  return eyes_face_the_camera(located.at, around[0], around[1], camera);
}

/// Aligns the middle of a feature alone, where `own` is its surroundings. What lies before or
/// behind those, as an eye in its socket or a lip below a nose, errs with the square of their size:
/// three quarters of it is what the middle, of half the size, differs by. Answers how far that may
/// be wrong [px]; 0 where noise explains the difference.
double Surface::come_near(const FaceArea& area, const Vector2d& at, Alignment& own) {
  const FaceArea middle{area.middle, 0.5 * area.half_width, 0.5 * area.half_height};
  Alignment near = own;
  if (!fit_.align_feature(middle, near)) return 0;
  const double difference = near.surface.at(at) - own.surface.at(at);
  const double variance =
      near.surface.variance(at, near.covariance) + own.surface.variance(at, own.covariance);
  if (!(difference * difference > kRelief * kRelief * variance)) return 0;
  own = near;
  own.surface.c[0] += difference / 3;
  return std::abs(difference) / 3;
}

FacePose Surface::pose(const Alignment& aligned, const StereoCamera& camera,
                       const Located& located) const {
  const bool is_plane = aligned.surface.is_plane();
  std::array<StereoPoint, 3> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& pixel = located.at[i];
    // All of a plane says where a point of it is; of a curved face only what is around the point.
    const Alignment& there = is_plane ? aligned : located.own[i];
    const DisparitySurface tangent = there.surface.tangent(pixel);
    const double disparity = there.surface.at(pixel);
    const double variance = there.surface.variance(pixel, there.covariance) +
                            kDisparityFloor * kDisparityFloor +
                            (is_plane ? 0 : located.relief[i] * located.relief[i]);
    const Vector3d point = camera.triangulate(pixel, {pixel.x() - disparity, pixel.y()});
    // By the column and the row of the landmark, which slides along the surface, and the disparity.
    const Vector3d by_disparity = -point / disparity;
    const double step = camera.baseline_m / disparity;
    Eigen::Matrix3d by;
    by.col(0) = Vector3d{step, 0, 0} + by_disparity * (tangent.c[1] / tangent.reach);
    by.col(1) = Vector3d{0, step, 0} + by_disparity * (tangent.c[2] / tangent.reach);
    by.col(2) = by_disparity;
    const double of_landmark = located.sigma[i] * located.sigma[i];
    points[i] = {point,
                 by * Vector3d{of_landmark, of_landmark, variance}.asDiagonal() * by.transpose()};
  }
  FacePose face = face_through(points[0], points[1], points[2]);
  face.residual_px = row_difference(aligned, located.at);
  const double reach = aligned.surface.reach;
  face.rows = RowDifference{.at_face_px = aligned.rows[0],
                            .by_column = aligned.rows[1] / reach,
                            .by_row = aligned.rows[2] / reach};
  if (!is_plane) return face;
  face.normal = aligned.surface.plane_normal(camera);
  // The normal of a plane does not depend on where on it the landmarks are.
  const Eigen::Matrix3d by_terms = aligned.surface.plane_normal_derivative(camera);
  face.normal_covariance =
      by_terms * aligned.covariance.topLeftCorner<3, 3>() * by_terms.transpose();
  return face;
}

}  // namespace armature::face_pose::surface

ARMATURE_PLUGIN(armature::face_pose::surface::Surface);
