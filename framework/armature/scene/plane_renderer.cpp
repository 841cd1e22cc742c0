// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/plane_renderer.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

namespace armature::scene {
namespace {

constexpr std::size_t kNoiseLength = std::size_t{1} << 16;
constexpr int kSmallestLevel = 16;  // px

std::uint64_t hashed(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Pixel (u, v) of level k covers the pixels from 2^k u on: its centre is at 2^k (u + 1/2) - 1/2.
Eigen::Matrix3d level_H_photo(int level) {
  const double scale = std::ldexp(1.0, -level);
  Eigen::Matrix3d h;
  h << scale, 0, 0.5 * scale - 0.5, 0, scale, 0.5 * scale - 0.5, 0, 0, 1;
  return h;
}

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

PlaneRenderer::PlaneRenderer(const Photo& photo, const ImagingSettings& settings,
                             std::uint64_t seed)
    : mouth_{photo.mouth},
      m_per_px_{photo.m_per_px},
      settings_{settings},
      blur_{settings.blur_px},
      seed_{seed} {
  Level level{photo.image.width, photo.image.height, {}};
  level.pixels.assign(photo.image.pixels.begin(), photo.image.pixels.end());
  pyramid_.push_back(std::move(level));
  while (pyramid_.back().width >= 2 * kSmallestLevel &&
         pyramid_.back().height >= 2 * kSmallestLevel) {
    const Level& fine = pyramid_.back();
    Level coarse{fine.width / 2, fine.height / 2, {}};
    for (int v = 0; v < coarse.height; ++v) {
      for (int u = 0; u < coarse.width; ++u) {
        const float* at = &fine.pixels[static_cast<std::size_t>(2 * v * fine.width + 2 * u)];
        coarse.pixels.push_back(0.25f * (at[0] + at[1] + at[fine.width] + at[fine.width + 1]));
      }
    }
    pyramid_.push_back(std::move(coarse));
  }

  std::mt19937_64 generator{seed};
  std::normal_distribution<float> normal{0.0f, static_cast<float>(settings.noise)};
  noise_.assign(kNoiseLength + kWidestImage, 0.0f);
  if (settings.noise > 0)
    std::generate(noise_.begin(), noise_.end(), [&] { return normal(generator); });
}

float PlaneRenderer::Level::sample(float u, float v) const {
  u = std::clamp(u, 0.0f, static_cast<float>(width - 1));
  v = std::clamp(v, 0.0f, static_cast<float>(height - 1));
  const int i = std::min(static_cast<int>(u), width - 2);
  const int j = std::min(static_cast<int>(v), height - 2);
  const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
  const float* at = &pixels[static_cast<std::size_t>(j * width + i)];
  const float top = at[0] + a * (at[1] - at[0]);
  const float bottom = at[width] + a * (at[width + 1] - at[width]);
  return top + b * (bottom - top);
}

void PlaneRenderer::render(const Eigen::Isometry3d& camera_T_photo, const StereoCamera& camera,
                           double brightness, std::uint64_t picture, std::span<std::uint8_t> out) {
  width_ = camera.width;
  height_ = camera.height;
  const auto background = static_cast<float>(settings_.background * brightness);
  canvas_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), background);

  // The photo's z points away from the viewer: seen from behind, it points towards the camera.
  const Eigen::Vector3d mouth = camera_T_photo.translation();
  const bool seen_from_front = camera_T_photo.linear().col(2).dot(mouth) > 0;
  if (seen_from_front) {
    Eigen::Matrix3d intrinsics, camera_G_photo;  // camera_G_photo: pixel (u, v, 1) -> a point
    intrinsics << camera.focal_px, 0, camera.cx, 0, camera.focal_px, camera.cy, 0, 0, 1;
    camera_G_photo << camera_T_photo.linear().leftCols<2>() * m_per_px_, mouth;
    camera_G_photo.col(2) -= camera_G_photo.leftCols<2>() * mouth_;
    const Eigen::Matrix3d image_H_photo = intrinsics * camera_G_photo;

    const double scale = mouth.z() > 0 ? minification(image_H_photo, mouth_) : 1.0;
    const int level = std::clamp(static_cast<int>(std::floor(std::log2(std::max(scale, 1.0)))), 0,
                                 static_cast<int>(pyramid_.size()) - 1);
    const int samples = scale > 1.0 ? 2 : 1;
    draw(covered(image_H_photo, camera), level_H_photo(level) * image_H_photo.inverse(),
         pyramid_[static_cast<std::size_t>(level)], samples, static_cast<float>(brightness),
         background);
  }
  quantise(picture, out);
}

PixelRegion PlaneRenderer::covered(const Eigen::Matrix3d& image_H_photo,
                                   const StereoCamera& camera) const {
  const double right = pyramid_[0].width - 0.5, bottom = pyramid_[0].height - 0.5;
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

void PlaneRenderer::draw(const PixelRegion& region, const Eigen::Matrix3d& photo_H_image,
                         const Level& level, int samples_per_side, float brightness,
                         float background) {
  if (region.empty()) return;
  const double step = 1.0 / samples_per_side;
  const float share = 1.0f / static_cast<float>(samples_per_side * samples_per_side);
  const float right = static_cast<float>(level.width) - 0.5f;
  const float bottom = static_cast<float>(level.height) - 0.5f;
  const Eigen::Vector3d across = photo_H_image.col(0) * step;
  for (int v = region.top; v < region.bottom; ++v) {
    float* row = &canvas_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_)];
    std::fill(row + region.left, row + region.right, 0.0f);
    for (int sub_row = 0; sub_row < samples_per_side; ++sub_row) {
      const Eigen::Vector3d first{region.left - 0.5 + 0.5 * step, v - 0.5 + (sub_row + 0.5) * step,
                                  1};
      Eigen::Vector3d p = photo_H_image * first;  // p.z = 1 / depth, up to a positive factor
      for (int u = region.left; u < region.right; ++u) {
        for (int sub = 0; sub < samples_per_side; ++sub, p += across) {
          const double inverse = 1.0 / p.z();
          const auto x = static_cast<float>(p.x() * inverse);
          const auto y = static_cast<float>(p.y() * inverse);
          const bool inside = p.z() > 0 && x >= -0.5f && x < right && y >= -0.5f && y < bottom;
          row[u] += share * (inside ? brightness * level.sample(x, y) : background);
        }
      }
    }
  }
  blur_.apply(canvas_, width_, region.grown(blur_.reach(), width_, height_));
}

void PlaneRenderer::quantise(std::uint64_t picture, std::span<std::uint8_t> out) const {
  const auto width = static_cast<std::size_t>(width_);
  for (std::size_t v = 0; v < static_cast<std::size_t>(height_); ++v) {
    const float* row = &canvas_[v * width];
    const float* noise = &noise_[hashed(hashed(seed_ + picture) + v) % kNoiseLength];
    std::uint8_t* to = &out[v * width];
    for (std::size_t u = 0; u < width; ++u) {
      const float value = row[u] + noise[u] + 0.5f;
      to[u] = static_cast<std::uint8_t>(static_cast<int>(std::min(std::max(value, 0.0f), 255.0f)));
    }
  }
}

}  // namespace armature::scene
