// SPDX-License-Identifier: Apache-2.0
#include "appearance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "armature/kinds/geometry_params.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/scene/generated_face.hpp"
#include "photo_file.hpp"

namespace armature::sim::photo_scene {
namespace {

constexpr double kMaxTurn = 1.45;  // [rad] of the eyes from the mouth around a head

// Eyes and mouth of NASA's portrait of Eileen Collins, in its pixels.
scene::Photo astronaut(const Parameters& parameters) {
  auto photo = read_photo(parameters.astronaut_file, {203.6, 101.8}, {246.9, 104.0}, {223.1, 144.4},
                          parameters.eye_distance);
  if (!photo) {
    throw SetupError(photo.error().text +
                     "; install the Debian package python3-imageio, or set photo: generated");
  }
  return std::move(*photo);
}

scene::Photo photo_from_file(const Parameters& parameters) {
  if (parameters.photo_file.empty()) {
    throw SetupError("photo: file needs photo_file, the PNG or JPEG that it is");
  }
  const auto& eyes = parameters.photo_eyes;
  const auto& mouth = parameters.photo_mouth;
  if (!(eyes[2] > eyes[0])) {
    throw SetupError(
        fmt::format("photo_eyes_px: the left eye is at column {} and the right one at {}; left is "
                    "as the picture shows it, so the right one's is larger",
                    eyes[0], eyes[2]));
  }
  auto photo = read_photo(parameters.photo_file, {eyes[0], eyes[1]}, {eyes[2], eyes[3]},
                          {mouth[0], mouth[1]}, parameters.eye_distance);
  if (!photo) throw SetupError(photo.error().text);
  for (const Eigen::Vector2d& at : {photo->left_eye, photo->right_eye, photo->mouth}) {
    if (at.x() >= 0 && at.y() >= 0 && at.x() < photo->image.width && at.y() < photo->image.height) {
      continue;
    }
    throw SetupError(fmt::format(
        "photo_eyes_px, photo_mouth_px: ({}, {}) is not on {}, which has "
        "{} x {} pixels",
        at.x(), at.y(), parameters.photo_file, photo->image.width, photo->image.height));
  }
  if (!(mouth[1] > std::max(eyes[1], eyes[3]))) {
    throw SetupError(fmt::format(
        "photo_mouth_px: the mouth is in row {}, and the eyes are in rows {} and {}; rows count "
        "down, and the mouth is below the eyes",
        mouth[1], eyes[1], eyes[3]));
  }
  return std::move(*photo);
}

/// How far the eyes are from the mouth along the surface [m], where it bends.
double bent_reach(scene::Surface::Shape shape, const scene::Photo& photo) {
  double reach = 0;
  for (const Eigen::Vector2d& eye : {photo.left_eye, photo.right_eye}) {
    const Eigen::Vector2d away = (eye - photo.mouth) * photo.m_per_px;
    const bool is_sphere = shape == scene::Surface::Shape::sphere;
    reach = std::max(reach, is_sphere ? away.norm() : std::abs(away.x()));
  }
  return reach;
}

}  // namespace

scene::Photo photo_of(const Parameters& parameters) {
  switch (parameters.photo) {
    case Parameters::Photo::generated:
      return scene::generated_face(parameters.face_seed, parameters.eye_distance);
    case Parameters::Photo::astronaut: return astronaut(parameters);
    case Parameters::Photo::file: return photo_from_file(parameters);
  }
  return {};
}

scene::Staging staging_of(const Parameters& parameters, const scene::Photo& photo) {
  // The choices stand in plugin.yaml in the order of the library's enumerators.
  const scene::Surface surface{static_cast<scene::Surface::Shape>(parameters.surface),
                               parameters.radius};
  if (surface.shape != scene::Surface::Shape::plane) {
    const double least = bent_reach(surface.shape, photo) / kMaxTurn;
    if (parameters.radius < least) {
      throw SetupError(fmt::format(
          "radius_mm: {:.0f} bends the photo so far that its eyes leave the front of the head; at "
          "least {:.0f} is needed",
          parameters.radius * 1e3, std::ceil(least * 1e3)));
    }
  }
  return {.surface = surface,
          .occluder = static_cast<scene::Occluder>(parameters.occluder),
          .second_face = parameters.second_face
                             ? std::optional{vector_of(parameters.second_face_position)}
                             : std::nullopt,
          .shadow = parameters.shadow};
}

scene::ImagingSettings imaging_of(const Parameters& parameters) {
  return {.noise = parameters.noise,
          .blur_px = parameters.blur,
          .background = parameters.background,
          .motion_px = {parameters.motion[0], parameters.motion[1]}};
}

scene::RightCamera right_camera_of(const Parameters& parameters) {
  return {.gain = parameters.right_gain,
          .roll = parameters.right_roll,
          .focal = 1 + parameters.right_focal_percent / 100,
          .shift_px = {parameters.right_shift[0], parameters.right_shift[1]}};
}

}  // namespace armature::sim::photo_scene
