// SPDX-License-Identifier: Apache-2.0
#include "surface.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::face_pose::surface {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::array kFeatures{FaceFeature::left_eye, FaceFeature::right_eye, FaceFeature::mouth};
constexpr std::array kAreas{kLeftEye, kRightEye, kMouth};
constexpr std::array kNames{"left eye", "right eye", "mouth"};
constexpr double kDisparityFloor = 0.01;  // [px] what interpolation between pixels leaves

/// The plane of the last pair, which is where the next one starts: its disparity at pixel (0, 0)
/// [px] and how it grows with the column and the row.
struct Memory {
  static constexpr auto kLayout = layout_id("face_pose/surface", 1);
  double at_origin, by_column, by_row;
};

const Vector2d& feature(const Features& features, std::size_t i) {
  return i == 0 ? features.left_eye : i == 1 ? features.right_eye : features.mouth;
}

Features features_of(const FaceLandmarks& face) {
  return {face.feature(FaceFeature::left_eye).point, face.feature(FaceFeature::right_eye).point,
          face.feature(FaceFeature::mouth).point};
}

/// Why pictures, landmarks and camera do not belong together, or nothing.
std::optional<std::string> invalid(const FacePoseInput& input) {
  for (const ImageView* image : {&input.left, &input.right}) {
    if (auto wrong = invalid_input(*image)) return wrong;
    if (image->width != input.camera.width || image->height != input.camera.height) {
      return fmt::format("a picture of {} x {} pixels of a camera with {} x {}", image->width,
                         image->height, input.camera.width, input.camera.height);
    }
  }
  for (const FaceLandmarks* face : {&input.landmarks.left, &input.landmarks.right}) {
    if (auto wrong = invalid_input(*face)) return wrong;
  }
  return std::nullopt;
}

/// Why these are no features of a face in that camera's picture, or nothing. How large the face is
/// in the picture bounds what is computed.
std::optional<std::string> invalid(const Features& features, const StereoCamera& camera) {
  constexpr double kFewestPixels = 8;  // between the eyes, and from them to the mouth
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    const Vector2d& at = feature(features, i);
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < camera.width && at.y() < camera.height)) {
      return fmt::format("the {} at ({:.0f}, {:.0f}) px is not in the picture", kNames[i], at.x(),
                         at.y());
    }
  }
  const Vector2d across = features.across(), down = features.down();
  const double area = across.x() * down.y() - across.y() * down.x();
  if (!(area >= kFewestPixels * kFewestPixels)) {
    return fmt::format("eyes and mouth span {:.0f} px2, too few for a face", area);
  }
  return std::nullopt;
}

/// [m/px] by how much a pixel of disparity moves what is in the middle of the face.
double depth_by_pixel(const DisparitySurface& surface, const StereoCamera& camera) {
  const double disparity = surface.at(surface.middle);
  return camera.focal_px * camera.baseline_m / (disparity * disparity);
}

/// The plane through the features' own disparities.
DisparitySurface plane_of(const Features& left, const Features& right) {
  const Vector2d middle = left.between_eyes() + 0.45 * left.down();
  DisparitySurface plane{.middle = middle,
                         .reach = std::max(left.across().norm(), left.down().norm())};
  Eigen::Matrix3d terms;
  Vector3d disparities;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    terms.row(row) << 1, plane.local(feature(left, i)).transpose();
    disparities[row] = feature(left, i).x() - feature(right, i).x();
  }
  plane.c.head<3>() = terms.partialPivLu().solve(disparities);
  return plane;
}

}  // namespace

Expected<std::unique_ptr<FacePoseEstimator>> Surface::make(const Params& params) {
  return std::make_unique<Surface>(Parameters::read(params));
}

Expected<FacePose> Surface::estimate(const FacePoseInput& input, PluginState& state) {
  if (auto wrong = invalid(input)) return refuse(*wrong);
  fit_.look_at(input.left, input.right);
  Located located{.at = features_of(input.landmarks.left), .sigma = {}, .own = {}};
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    located.sigma[i] = input.landmarks.left.feature(kFeatures[i]).sigma;
  }
  const auto starts = starts_of(located.at, features_of(input.landmarks.right), state);
  if (!starts) return tl::unexpected{starts.error()};
  Alignment aligned;
  auto face = look(input, *starts, aligned, located);
  // Landmarks of a turned face may be so far off that the frontal view they lead to is a poor one.
  // What was found in it leads to a good one.
  if (!face && located.is_unsettled) {
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
    return refuse(fmt::format("the face has a disparity of {:.2f} px, not a positive one",
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
  if (auto wrong = invalid(located.at, input.camera)) return refuse(*wrong);
  const auto fitted = fit_.align(located.at, starts);
  if (!fitted) return tl::unexpected{fitted.error()};
  aligned = *fitted;
  for (const auto& sound :
       {agree(aligned, input.camera), see_features(aligned, input.camera, located),
        rectified(aligned, input.camera)}) {
    if (!sound) return tl::unexpected{sound.error()};
  }
  if (input.finder) {
    if (auto found = find_again(input, aligned, located); !found) {
      return tl::unexpected{found.error()};
    }
  }
  const FacePose face = pose(aligned, input.camera, located);
  if (auto sound = believable(face); !sound) return tl::unexpected{sound.error()};
  return face;
}

Expected<void> Surface::agree(const Alignment& aligned, const StereoCamera& camera) const {
  if (aligned.agreeing < parameters_.min_agreement) {
    return refuse(fmt::format("the pictures agree in {:.0f} % of the face only, less than {:.0f} %",
                              aligned.agreeing * 100, parameters_.min_agreement * 100));
  }
  if (aligned.gain < 1 / parameters_.max_gain || aligned.gain > parameters_.max_gain) {
    return refuse(
        fmt::format("the left picture is {:.2f} times as bright as the right one, more "
                    "than {:.2f} times",
                    aligned.gain, parameters_.max_gain));
  }
  const double hollow = aligned.surface.hollowness() * depth_by_pixel(aligned.surface, camera);
  if (hollow > parameters_.max_hollowness) {
    return refuse(
        fmt::format("the face would be hollow by {:.1f} mm, more than {:.1f}: something "
                    "covers a part of it",
                    hollow * 1e3, parameters_.max_hollowness * 1e3));
  }
  return {};
}

Expected<void> Surface::rectified(const Alignment& aligned, const StereoCamera& camera) const {
  // Rows that differ come with columns that do: a turn of a camera tilts the face by as much as
  // its slope over what a pixel of disparity means.
  const double disparity = aligned.surface.at(aligned.surface.middle);
  const double slope = aligned.rows.tail<2>().norm() / aligned.surface.reach;
  const double tilt = std::atan(slope * camera.focal_px / disparity);
  if (tilt > parameters_.max_misrectification_tilt ||
      std::abs(aligned.rows[0]) > parameters_.max_row_error) {
    return refuse(
        fmt::format("the pictures are not rectified: their rows differ by {:.2f} px, and "
                    "by {:.2f} px from one side of the face to the other, which is a "
                    "tilt of {:.1f} degrees; calibrate the cameras again",
                    std::abs(aligned.rows[0]), 2 * aligned.rows.tail<2>().norm(), tilt * kDegrees));
  }
  return {};
}

// What a finder sees stays where it is when its box moves; what it makes up moves with the box.
Expected<void> Surface::find_again(const FacePoseInput& input, const Alignment& aligned,
                                   Located& located) {
  view_.render(input.left, input.right, aligned, located.at, input.camera);
  std::array<std::array<Landmark, 3>, 2> looks;
  for (std::size_t look = 0; look < looks.size(); ++look) {
    const auto found = input.finder->find(view_.image(), view_.face_boxes()[look]);
    if (!found) return refuse("frontal view: " + found.error().text);
    const FaceLandmarks face{.scheme = input.finder->scheme(), .points = *found, .box = {}};
    if (auto wrong = invalid_input(face)) return refuse("frontal view: " + *wrong);
    for (std::size_t i = 0; i < kFeatures.size(); ++i) looks[look][i] = face.feature(kFeatures[i]);
  }
  const Features before = located.at;
  std::array<Vector2d, 3> in_left;
  std::string unsettled;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    const Vector2d &one = looks[0][i].point, &other = looks[1][i].point;
    const Vector2d mean = 0.5 * (one + other);
    in_left[i] = view_.in_left(mean);
    const double px_per_px = (view_.in_left(mean + Vector2d{1, 0}) - in_left[i]).norm();
    located.sigma[i] = looks[0][i].sigma * px_per_px;
    const double with_box = (one - other).norm() / view_.eye_distance();
    const double moved = (in_left[i] - feature(before, i)).norm() / before.across().norm();
    if (!(with_box <= parameters_.max_unsteadiness)) {
      unsettled = fmt::format(
          "the {} is not to be seen: sought from another box it seems to be "
          "elsewhere, by {:.0f} % of the eyes' distance",
          kNames[i], 100 * with_box);
    } else if (!(moved <= parameters_.max_disagreement)) {
      unsettled = fmt::format(
          "the {} is elsewhere in a frontal view, by {:.0f} % of the eyes' "
          "distance",
          kNames[i], 100 * moved);
    }
  }
  located.at = {in_left[0], in_left[1], in_left[2]};
  located.is_unsettled = !unsettled.empty();
  if (located.is_unsettled) return refuse(unsettled);
  return {};
}

Expected<void> Surface::see_features(const Alignment& aligned, const StereoCamera& camera,
                                     Located& located) {
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    Alignment& own = located.own[i] = aligned;
    if (!fit_.align_feature(kAreas[i], own)) {
      return refuse(fmt::format("too little of the {} is in both pictures", kNames[i]));
    }
    if (own.agreeing < parameters_.min_agreement) {
      return refuse(
          fmt::format("the {} looks different to both cameras: {:.0f} % of it agree, "
                      "less than {:.0f} %",
                      kNames[i], own.agreeing * 100, parameters_.min_agreement * 100));
    }
    const Vector2d& at = feature(located.at, i);
    const double relief = own.surface.point(at, camera).z() - aligned.surface.point(at, camera).z();
    if (!(std::abs(relief) <= parameters_.max_relief)) {
      return refuse(
          fmt::format("the {} lies {:.1f} mm {} the face, more than {:.1f}: something "
                      "covers it",
                      kNames[i], std::abs(relief) * 1e3, relief < 0 ? "before" : "behind",
                      parameters_.max_relief * 1e3));
    }
    const double sigma = own.surface.point(at, camera).z() / own.surface.at(at) *
                         std::sqrt(own.surface.variance(at, own.covariance));
    if (!(sigma <= parameters_.max_depth_sigma)) {
      return refuse(
          fmt::format("the {} shows too little: its depth is known to {:.1f} mm only, "
                      "not to {:.1f}",
                      kNames[i], sigma * 1e3, parameters_.max_depth_sigma * 1e3));
    }
  }
  return {};
}

FacePose Surface::pose(const Alignment& aligned, const StereoCamera& camera,
                       const Located& located) const {
  const bool is_plane = aligned.surface.is_plane();
  std::array<StereoPoint, 3> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& pixel = feature(located.at, i);
    // All of a plane says where a point of it is; of a curved face only what is around the point.
    const Alignment& there = is_plane ? aligned : located.own[i];
    const DisparitySurface tangent = there.surface.tangent(pixel);
    const double disparity = there.surface.at(pixel);
    const double variance =
        there.surface.variance(pixel, there.covariance) + kDisparityFloor * kDisparityFloor;
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
  if (!is_plane) return face;
  face.normal = aligned.surface.plane_normal(camera);
  // The normal of a plane does not depend on where on it the landmarks are.
  const Eigen::Matrix3d by_terms = aligned.surface.plane_normal_derivative(camera);
  face.normal_covariance =
      by_terms * aligned.covariance.topLeftCorner<3, 3>() * by_terms.transpose();
  return face;
}

Expected<void> Surface::believable(const FacePose& face) const {
  const double depth = face.mouth.z();
  if (!(depth >= parameters_.min_depth && depth <= parameters_.max_depth)) {
    return refuse(fmt::format("the mouth would be {:.3f} m away, outside {} to {} m", depth,
                              parameters_.min_depth, parameters_.max_depth));
  }
  const double eyes = (face.right_eye - face.left_eye).norm();
  if (!(eyes >= parameters_.min_eye_distance && eyes <= parameters_.max_eye_distance)) {
    return refuse(fmt::format("the eyes would be {:.1f} mm apart, outside {:.0f} to {:.0f} mm",
                              eyes * 1e3, parameters_.min_eye_distance * 1e3,
                              parameters_.max_eye_distance * 1e3));
  }
  const double tilt = std::acos(std::clamp(facing(face), -1.0, 1.0));
  if (!(tilt <= parameters_.max_tilt)) {
    return refuse(fmt::format("the face would be seen from {:.0f} degrees aside, more than {:.0f}",
                              tilt * kDegrees, parameters_.max_tilt * kDegrees));
  }
  const double sigma = std::sqrt(face.normal_covariance.trace());
  if (!(sigma <= parameters_.max_normal_sigma)) {
    return refuse(fmt::format("the normal would be known to {:.2f} degrees only, not to {:.2f}",
                              sigma * kDegrees, parameters_.max_normal_sigma * kDegrees));
  }
  return {};
}

}  // namespace armature::face_pose::surface

ARMATURE_PLUGIN(armature::face_pose::surface::Surface);
