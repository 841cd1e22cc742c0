// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/surface.hpp"

#include <cmath>

namespace armature::scene {
namespace {

/// The smaller root of a t^2 + 2 b t + c = 0 when it lies ahead: where a ray enters.
std::optional<double> entry(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || a <= 0) return std::nullopt;
  const double t = (-b - std::sqrt(discriminant)) / a;
  return t > 0 ? std::optional{t} : std::nullopt;
}

std::optional<Eigen::Vector2d> on_plane(const Ray& ray) {
  if (ray.direction.z() <= 0 || ray.origin.z() >= 0) return std::nullopt;
  const double t = -ray.origin.z() / ray.direction.z();
  return (ray.origin + t * ray.direction).head<2>();
}

std::optional<Eigen::Vector2d> on_cylinder(const Ray& ray, double radius) {
  const Eigen::Vector2d from{ray.origin.x(), ray.origin.z() - radius};
  const Eigen::Vector2d along{ray.direction.x(), ray.direction.z()};
  const auto t = entry(along.squaredNorm(), from.dot(along), from.squaredNorm() - radius * radius);
  if (!t) return std::nullopt;
  const Eigen::Vector2d at = from + *t * along;
  return Eigen::Vector2d{radius * std::atan2(at.x(), -at.y()),
                         ray.origin.y() + *t * ray.direction.y()};
}

std::optional<Eigen::Vector2d> on_sphere(const Ray& ray, double radius) {
  const Eigen::Vector3d from = ray.origin - Eigen::Vector3d{0, 0, radius};
  const auto t = entry(ray.direction.squaredNorm(), from.dot(ray.direction),
                       from.squaredNorm() - radius * radius);
  if (!t) return std::nullopt;
  const Eigen::Vector3d at = from + *t * ray.direction;
  const double aside = at.head<2>().norm();
  if (aside == 0) return Eigen::Vector2d::Zero();
  return Eigen::Vector2d{at.head<2>() * (radius * std::atan2(aside, -at.z()) / aside)};
}

}  // namespace

Eigen::Vector3d Surface::point(const Eigen::Vector2d& flat) const {
  switch (shape) {
    case Shape::plane: return {flat.x(), flat.y(), 0};
    case Shape::cylinder: {
      const double turn = flat.x() / radius_m;
      return {radius_m * std::sin(turn), flat.y(), radius_m * (1 - std::cos(turn))};
    }
    case Shape::sphere: {
      const double turn = flat.norm() / radius_m;
      const double share = turn > 0 ? std::sin(turn) / turn : 1.0;
      return {share * flat.x(), share * flat.y(), radius_m * (1 - std::cos(turn))};
    }
  }
  return {};
}

std::optional<Eigen::Vector2d> Surface::met_by(const Ray& ray) const {
  if (shape == Shape::plane) return on_plane(ray);
  return shape == Shape::cylinder ? on_cylinder(ray, radius_m) : on_sphere(ray, radius_m);
}

Eigen::Vector3d FacePoints::normal() const {
  return (right_eye - mouth).cross(left_eye - mouth).normalized();
}

FacePoints FacePoints::in(const Eigen::Isometry3d& a_T_points) const {
  return {a_T_points * left_eye, a_T_points * right_eye, a_T_points * mouth};
}

FacePoints face_points(const Photo& photo, const Surface& surface) {
  const auto at = [&](const Eigen::Vector2d& pixel) {
    return surface.point((pixel - photo.mouth) * photo.m_per_px);
  };
  return {at(photo.left_eye), at(photo.right_eye), at(photo.mouth)};
}

}  // namespace armature::scene
