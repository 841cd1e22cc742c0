// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/photo_layer.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace armature::scene {
namespace {

/// Photo pixels per image pixel, at the image of photo pixel `p`: the larger singular value.
double minification(const Eigen::Matrix3d& image_H_photo, const Eigen::Vector2d& p) {
  const Eigen::Vector3d h = image_H_photo * p.homogeneous();
  Eigen::Matrix2d image_per_photo;
  for (int row = 0; row < 2; ++row) {
    image_per_photo.row(row) =
        (image_H_photo.block<1, 2>(row, 0) * h.z() - image_H_photo.block<1, 2>(2, 0) * h(row)) /
        (h.z() * h.z());
  }
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd{image_per_photo};
  return 1.0 / std::max(svd.singularValues()(1), 1e-6);
}

}  // namespace

PhotoLayer::PhotoLayer(const Photo& photo, const Surface& surface)
    : pyramid_{photo.image}, surface_{surface}, mouth_{photo.mouth}, m_per_px_{photo.m_per_px} {}

PixelRegion PhotoLayer::draw(Canvas& canvas, const View& view) {
  // The face's z points away from the viewer: seen from behind, it points towards the camera.
  const Eigen::Vector3d mouth = view.camera_T_face.translation();
  const bool is_flat = surface_.shape == Surface::Shape::plane;
  if (is_flat && view.camera_T_face.linear().col(2).dot(mouth) <= 0) return {};

  Eigen::Matrix3d intrinsics, camera_G_photo;  // camera_G_photo: pixel (u, v, 1) -> a point
  intrinsics << view.camera.focal_px, 0, view.camera.cx, 0, view.camera.focal_px, view.camera.cy, 0,
      0, 1;
  camera_G_photo << view.camera_T_face.linear().leftCols<2>() * m_per_px_, mouth;
  camera_G_photo.col(2) -= camera_G_photo.leftCols<2>() * mouth_;
  const Eigen::Matrix3d image_H_photo = intrinsics * camera_G_photo;  // of the plane at the mouth
  const double scale = mouth.z() > 0 ? minification(image_H_photo, mouth_) : 1.0;
  const int level = pyramid_.level_for(scale);
  if (is_flat) {
    const PixelRegion region = covered_by_plane(image_H_photo, view);
    draw_flat(canvas, region, ImagePyramid::level_H_photo(level) * image_H_photo.inverse(),
              pyramid_.level(level), scale > 1.0 ? 2 : 1, static_cast<float>(view.brightness));
    return region;
  }
  const PixelRegion region = covered(view, hull());
  draw_curved(canvas, view, region, level);
  return region;
}

PixelRegion PhotoLayer::covered_by_plane(const Eigen::Matrix3d& image_H_photo,
                                         const View& view) const {
  const StereoCamera& camera = view.camera;
  const double right = pyramid_.level(0).width - 0.5, bottom = pyramid_.level(0).height - 0.5;
  Eigen::Matrix<double, 3, 4> corners;
  corners << -0.5, right, right, -0.5, -0.5, -0.5, bottom, bottom, 1, 1, 1, 1;
  corners = (image_H_photo * corners).eval();
  if ((corners.row(2).array() <= 0).any()) return {0, 0, camera.width, camera.height};
  const Eigen::Array4d u = corners.row(0).cwiseQuotient(corners.row(2)).transpose();
  const Eigen::Array4d v = corners.row(1).cwiseQuotient(corners.row(2)).transpose();
  const auto pixel = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x), 0.0, static_cast<double>(size)));
  };
  return {pixel(u.minCoeff(), camera.width), pixel(v.minCoeff(), camera.height),
          pixel(u.maxCoeff() + 1, camera.width), pixel(v.maxCoeff() + 1, camera.height)};
}

void PhotoLayer::draw_flat(Canvas& canvas, const PixelRegion& region,
                           const Eigen::Matrix3d& photo_H_image, const ImagePyramid::Level& level,
                           int samples_per_side, float brightness) {
  if (region.empty()) return;
  const double step = 1.0 / samples_per_side;
  const float share = 1.0f / static_cast<float>(samples_per_side * samples_per_side);
  const Eigen::Vector3d across = photo_H_image.col(0) * step;
  for (int v = region.top; v < region.bottom; ++v) {
    float* row = canvas.row(v);
    under_.assign(row, row + region.right);
    std::fill(row + region.left, row + region.right, 0.0f);
    for (int sub_row = 0; sub_row < samples_per_side; ++sub_row) {
      const Eigen::Vector3d first{region.left - 0.5 + 0.5 * step, v - 0.5 + (sub_row + 0.5) * step,
                                  1};
      Eigen::Vector3d p = photo_H_image * first;  // p.z = 1 / depth, up to a positive factor
      for (int u = region.left; u < region.right; ++u) {
        float sum = row[u];
        for (int sub = 0; sub < samples_per_side; ++sub, p += across) {
          const double inverse = 1.0 / p.z();
          const auto x = static_cast<float>(p.x() * inverse);
          const auto y = static_cast<float>(p.y() * inverse);
          const bool inside = p.z() > 0 && level.contains(x, y);
          sum += share *
                 (inside ? brightness * level.sample(x, y) : under_[static_cast<std::size_t>(u)]);
        }
        row[u] = sum;
      }
    }
  }
}

void PhotoLayer::draw_curved(Canvas& canvas, const View& view, const PixelRegion& region,
                             int level) const {
  const ImagePyramid::Level& pixels = pyramid_.level(level);
  const double scale = std::ldexp(1.0, -level) / m_per_px_;
  const Eigen::Vector2d mouth =
      (ImagePyramid::level_H_photo(level) * mouth_.homogeneous()).hnormalized();
  draw_by_rays(canvas, view, region, 2, [&](const Ray& ray) -> std::optional<double> {
    const auto flat = surface_.met_by(ray);
    if (!flat) return std::nullopt;
    const Eigen::Vector2f p = (mouth + scale * *flat).cast<float>();
    if (!pixels.contains(p.x(), p.y())) return std::nullopt;
    return pixels.sample(p.x(), p.y());
  });
}

// The box around all of the surface that the photo covers, from the face's foremost plane on.
std::vector<Eigen::Vector3d> PhotoLayer::hull() const {
  const ImagePyramid::Level& all = pyramid_.level(0);
  const Eigen::Vector2d low = -m_per_px_ * (mouth_ + Eigen::Vector2d{0.5, 0.5});
  const Eigen::Vector2d high = m_per_px_ * (Eigen::Vector2d{all.width, all.height} - mouth_);
  const double around = surface_.radius_m;
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm();
  const double depth = around * (1 - std::cos(std::min(reach / around, M_PI)));
  const bool is_round = surface_.shape == Surface::Shape::sphere;
  std::vector<Eigen::Vector3d> corners;
  for (const double x : {std::max(low.x(), -around), std::min(high.x(), around)}) {
    for (const double y : {is_round ? std::max(low.y(), -around) : low.y(),
                           is_round ? std::min(high.y(), around) : high.y()}) {
      for (const double z : {0.0, depth}) corners.emplace_back(x, y, z);
    }
  }
  return corners;
}

}  // namespace armature::scene
