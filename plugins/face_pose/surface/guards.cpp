// SPDX-License-Identifier: Apache-2.0
#include "guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "armature/kinds/face_pose/stereo_points.hpp"

namespace armature::face_pose::surface {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
// A finder sees the border and not the middle of an eye that turns away from the camera on a narrow
// head, and sees it so in every look.
constexpr double kMaxAside = 50 / kDegrees, kMaxApart = 56 / kDegrees;
constexpr double kMaxShift = 0.003;  // [m] by which pictures that are not rectified move a face

/// [m/px] by how much a pixel of disparity moves what is in the middle of the face.
double depth_by_pixel(const DisparitySurface& surface, const StereoCamera& camera) {
  const double disparity = surface.at(surface.middle);
  return camera.focal_px * camera.baseline_m / (disparity * disparity);
}

}  // namespace

Expected<void> input_is_sound(const FacePoseInput& input) {
  for (const ImageView* image : {&input.left, &input.right}) {
    if (auto wrong = invalid_input(*image)) return refuse(FaceRefusal::bad_input, *wrong);
    if (image->width != input.camera.width || image->height != input.camera.height) {
      return refuse(
          FaceRefusal::bad_input,
          fmt::format("a picture of {} x {} pixels of a camera with {} x {}", image->width,
                      image->height, input.camera.width, input.camera.height));
    }
  }
  for (const FaceLandmarks* face : {&input.landmarks.left, &input.landmarks.right}) {
    if (auto wrong = invalid_input(*face)) return refuse(FaceRefusal::bad_input, *wrong);
  }
  return {};
}

Expected<void> face_is_in_picture(const Features& features, const StereoCamera& camera) {
  constexpr double kFewestPixels = 8;  // between the eyes, and from them to the mouth
  for (std::size_t i = 0; i < kFaceFeatures.size(); ++i) {
    const Eigen::Vector2d& at = features[i];
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < camera.width && at.y() < camera.height)) {
      return refuse(FaceRefusal::implausible,
                    fmt::format("the {} at ({:.0f}, {:.0f}) px is not in the picture",
                                kFaceFeatures[i].name, at.x(), at.y()));
    }
  }
  const Eigen::Vector2d across = features.across(), down = features.down();
  const double area = across.x() * down.y() - across.y() * down.x();
  if (!(area >= kFewestPixels * kFewestPixels)) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("eyes and mouth span {:.0f} px2, too few for a face", area));
  }
  return {};
}

Expected<void> pictures_agree(const Alignment& aligned, const StereoCamera& camera,
                              const Parameters& parameters) {
  if (aligned.agreeing < parameters.min_agreement) {
    return refuse(FaceRefusal::covered,
                  fmt::format("the pictures agree in {:.0f} % of the face only, less than {:.0f} %",
                              aligned.agreeing * 100, parameters.min_agreement * 100));
  }
  if (aligned.gain < 1 / parameters.max_gain || aligned.gain > parameters.max_gain) {
    return refuse(FaceRefusal::brightness,
                  fmt::format("the left picture is {:.2f} times as bright as the right one, more "
                              "than {:.2f} times",
                              aligned.gain, parameters.max_gain));
  }
  const double hollow = aligned.surface.hollowness() * depth_by_pixel(aligned.surface, camera);
  if (hollow > parameters.max_hollowness) {
    return refuse(FaceRefusal::covered,
                  fmt::format("the face would be hollow by {:.1f} mm, more than {:.1f}: something "
                              "covers a part of it",
                              hollow * 1e3, parameters.max_hollowness * 1e3));
  }
  return {};
}

Expected<void> feature_is_uncovered(const char* name, const Eigen::Vector2d& at,
                                    const Alignment& own, const Alignment& aligned,
                                    const StereoCamera& camera, const Parameters& parameters) {
  if (own.agreeing < parameters.min_agreement) {
    return refuse(FaceRefusal::covered,
                  fmt::format("the {} looks different to both cameras: {:.0f} % of it agree, "
                              "less than {:.0f} %",
                              name, own.agreeing * 100, parameters.min_agreement * 100));
  }
  const double relief = own.surface.point(at, camera).z() - aligned.surface.point(at, camera).z();
  if (!(std::abs(relief) <= parameters.max_relief)) {
    return refuse(FaceRefusal::covered,
                  fmt::format("the {} lies {:.1f} mm {} the face, more than {:.1f}: something "
                              "covers it",
                              name, std::abs(relief) * 1e3, relief < 0 ? "before" : "behind",
                              parameters.max_relief * 1e3));
  }
  const double sigma = own.surface.point(at, camera).z() / own.surface.at(at) *
                       std::sqrt(own.surface.variance(at, own.covariance));
  if (!(sigma <= parameters.max_depth_sigma)) {
    return refuse(FaceRefusal::uncertain,
                  fmt::format("the {} shows too little: its depth is known to {:.1f} mm only, "
                              "not to {:.1f}",
                              name, sigma * 1e3, parameters.max_depth_sigma * 1e3));
  }
  return {};
}

Expected<void> eyes_face_the_camera(const Features& features, const DisparitySurface& left,
                                    const DisparitySurface& right, const StereoCamera& camera) {
  const std::array normals{left.tangent(features.left_eye).plane_normal(camera),
                           right.tangent(features.right_eye).plane_normal(camera)};
  const double apart = std::acos(std::clamp(normals[0].dot(normals[1]), -1., 1.));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d sight = (i == 0 ? left : right).point(features[i], camera).normalized();
    const double aside = std::acos(std::clamp(-sight.dot(normals[i]), -1., 1.));
    if (aside <= kMaxAside || apart <= kMaxApart) continue;
    return refuse(FaceRefusal::implausible,
                  fmt::format("the {} is seen from {:.0f} degrees aside on a head so narrow that "
                              "its eyes look {:.0f} degrees apart, more than {:.0f}",
                              kFaceFeatures[i].name, aside * kDegrees, apart * kDegrees,
                              kMaxApart * kDegrees));
  }
  return {};
}

Expected<void> pictures_are_rectified(const Alignment& aligned, const StereoCamera& camera,
                                      const Parameters& parameters) {
  // Rows that differ come with columns that do: a turn of a camera tilts the face by as much as
  // its slope over what a pixel of disparity means.
  const double disparity = aligned.surface.at(aligned.surface.middle);
  const double slope = aligned.rows.tail<2>().norm() / aligned.surface.reach;
  const double tilt = std::atan(slope * camera.focal_px / disparity);
  if (tilt > parameters.max_misrectification_tilt ||
      std::abs(aligned.rows[0]) > parameters.max_row_error) {
    return refuse(
        FaceRefusal::not_rectified,
        fmt::format("the pictures are not rectified: their rows differ by {:.2f} px, and "
                    "by {:.2f} px from one side of the face to the other, which is a "
                    "tilt of {:.1f} degrees; calibrate the cameras again",
                    std::abs(aligned.rows[0]), 2 * aligned.rows.tail<2>().norm(), tilt * kDegrees));
  }
  // Another focal length or a roll moves columns aside from the optical axis, too: rows by
  // (a x + b y) means columns by (b x - a y).
  const Eigen::Vector2d aside = aligned.surface.middle - Eigen::Vector2d{camera.cx, camera.cy};
  const double columns =
      (aligned.rows[2] * aside.x() - aligned.rows[1] * aside.y()) / aligned.surface.reach;
  const double shift = std::abs(columns) * depth_by_pixel(aligned.surface, camera);
  if (shift > kMaxShift) {
    return refuse(FaceRefusal::not_rectified,
                  fmt::format("the pictures are not rectified: their rows differ as with another "
                              "focal length or a turn that moves the face by {:.1f} mm, more than "
                              "{:.1f}; calibrate the cameras again",
                              shift * 1e3, kMaxShift * 1e3));
  }
  return {};
}

Expected<void> face_is_believable(const FacePose& face, const Parameters& parameters) {
  const double depth = face.mouth.z();
  if (!(depth >= parameters.min_depth && depth <= parameters.max_depth)) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the mouth would be {:.3f} m away, outside {} to {} m", depth,
                              parameters.min_depth, parameters.max_depth));
  }
  const double eyes = (face.right_eye - face.left_eye).norm();
  if (!(eyes >= parameters.min_eye_distance && eyes <= parameters.max_eye_distance)) {
    return refuse(
        FaceRefusal::implausible,
        fmt::format("the eyes would be {:.1f} mm apart, outside {:.0f} to {:.0f} mm", eyes * 1e3,
                    parameters.min_eye_distance * 1e3, parameters.max_eye_distance * 1e3));
  }
  const double tilt = std::acos(std::clamp(facing(face), -1.0, 1.0));
  if (!(tilt <= parameters.max_tilt)) {
    return refuse(FaceRefusal::implausible,
                  fmt::format("the face would be seen from {:.0f} degrees aside, more than {:.0f}",
                              tilt * kDegrees, parameters.max_tilt * kDegrees));
  }
  const double sigma = std::sqrt(face.normal_covariance.trace());
  if (!(sigma <= parameters.max_normal_sigma)) {
    return refuse(FaceRefusal::uncertain,
                  fmt::format("the normal would be known to {:.2f} degrees only, not to {:.2f}",
                              sigma * kDegrees, parameters.max_normal_sigma * kDegrees));
  }
  return {};
}

}  // namespace armature::face_pose::surface
