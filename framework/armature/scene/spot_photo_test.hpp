// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "armature/scene/scene_renderer.hpp"

namespace armature::scene {

constexpr double kDegree = std::numbers::pi / 180;
inline const StereoCamera kCamera{
    .width = 640, .height = 480, .focal_px = 500, .cx = 319.5, .cy = 239.5, .baseline_m = 0.12};

inline Photo flat_photo(std::uint8_t grey) {
  Photo photo{.image = {.width = 400, .height = 500},
              .left_eye = {150, 150},
              .right_eye = {250, 150},
              .mouth = {200, 250},
              .m_per_px = 0.0005};
  photo.image.pixels.assign(400 * 500, grey);
  return photo;
}

/// Black, with one round spot whose centre of gravity is at `at`.
inline Photo spot_photo(const Eigen::Vector2d& at) {
  Photo photo = flat_photo(0);
  for (int v = 0; v < photo.image.height; ++v) {
    for (int u = 0; u < photo.image.width; ++u) {
      const double r2 = (Eigen::Vector2d{u, v} - at).squaredNorm();
      photo.image.pixels[static_cast<std::size_t>(v * photo.image.width + u)] =
          static_cast<std::uint8_t>(std::lround(250 * std::exp(-r2 / (2 * 3.5 * 3.5))));
    }
  }
  return photo;
}

using Picture = std::vector<std::uint8_t>;

inline Picture render(SceneRenderer& renderer, const Eigen::Isometry3d& camera_T_photo,
                      const StereoCamera& camera = kCamera, double brightness = 1,
                      std::uint64_t number = 0) {
  Picture picture(static_cast<std::size_t>(camera.width * camera.height));
  renderer.render(camera_T_photo, camera, brightness, number, picture);
  return picture;
}

inline Eigen::Vector2d centroid(const Picture& picture, const StereoCamera& camera) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double w = picture[static_cast<std::size_t>(v * camera.width + u)];
      sum += w * Eigen::Vector2d{u, v};
      weight += w;
    }
  }
  return sum / weight;
}

inline Eigen::Isometry3d placed(const Eigen::Vector3d& position, double yaw = 0, double pitch = 0) {
  return Eigen::Translation3d{position} * (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
                                           Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()});
}

inline double mean(const Picture& picture) {
  double sum = 0;
  for (const auto value : picture) sum += value;
  return sum / static_cast<double>(picture.size());
}

}  // namespace armature::scene
