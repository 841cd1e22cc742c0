// SPDX-License-Identifier: Apache-2.0
#include "sphere_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace armature::markers::spheres {
namespace {

using Eigen::Vector3d;

constexpr int kDirections = 400;

/// Evenly over the sphere (Fibonacci's spiral), in pairs of opposite ones, so that what blurs both
/// alike moves no centre.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> all;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections / 2; ++i) {
    const double z = (i + 0.5) / (kDirections / 2);
    const double across = std::sqrt(1 - z * z);
    all.emplace_back(across * std::cos(i * turn), across * std::sin(i * turn), z);
    all.push_back(-all.back());
  }
  return all;
}

/// The width of a voxel along `direction` [m]: over it an edge is blurred.
double width_along(const VolumeGeometry& geometry, const Vector3d& direction) {
  return (geometry.direction.transpose() * direction).cwiseAbs().dot(geometry.spacing);
}

/// The mean density well inside.
double density_of(const Volume& volume, const Vector3d& centre, double radius) {
  double sum = hounsfield_at(volume, centre);
  int count = 1;
  for (int i = 0; i < 6; ++i) {
    const Vector3d aside =
        (i % 2 == 0 ? 0.4 : -0.4) * radius * volume.geometry.direction.col(i / 2);
    sum += hounsfield_at(volume, centre + aside);
    ++count;
  }
  return sum / count;
}

std::optional<Vector3d> edge_along(const Volume& volume, const Vector3d& centre,
                                   const Vector3d& direction, double radius, double inside) {
  const double width = width_along(volume.geometry, direction);
  const auto value = [&](double t) { return hounsfield_at(volume, centre + t * direction); };
  const double outside = value(radius + width);
  const double level = 0.5 * (inside + outside);
  const double step = 0.1 * volume.geometry.spacing.minCoeff();
  double before = value(0.5 * radius);
  if (!(before > level)) return std::nullopt;
  for (double t = 0.5 * radius + step; t < radius + width + step; t += step) {
    const double here = value(t);
    if (here <= level) {
      return centre + (t - step * (level - here) / (before - here)) * direction;
    }
    before = here;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Vector3d> surface_points(const Volume& volume, const Vector3d& centre, double radius) {
  static const std::vector<Vector3d> kAll = directions();
  const double inside = density_of(volume, centre, radius);
  std::vector<Vector3d> points;
  for (const Vector3d& along : kAll) {
    const Vector3d direction = volume.geometry.direction * along;  // the same voxels in any frame
    if (const auto edge = edge_along(volume, centre, direction, radius, inside)) {
      points.push_back(*edge);
    }
  }
  if (points.size() < kDirections * 3 / 4) points.clear();
  return points;
}

FittedSphere fitted_sphere(const std::vector<Vector3d>& points, const Vector3d& centre,
                           double radius) {
  FittedSphere sphere{.centre = centre, .radius = radius};
  double scale = radius;  // beyond twice of it a point has less weight
  for (int round = 0; round < 12; ++round) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double sum = 0, weights = 0;
    for (const Vector3d& point : points) {
      const Vector3d out = point - sphere.centre;
      const double off = out.norm() - sphere.radius;
      const double weight = std::min(1.0, 2 * scale / std::max(std::abs(off), 1e-12));
      Eigen::Vector4d row;
      row << out.normalized(), 1;
      normal += weight * row * row.transpose();
      right += weight * off * row;
      sum += weight * off * off;
      weights += weight;
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver{normal};
    const Eigen::Vector4d step = solver.solve(right);
    sphere.centre += step.head<3>();
    sphere.radius += step[3];
    sphere.rms = std::sqrt(sum / weights);
    const Eigen::Matrix4d covariance = solver.solve(Eigen::Matrix4d::Identity());
    sphere.spread = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    scale = std::max(sphere.rms, 1e-7);
  }
  return sphere;
}

}  // namespace armature::markers::spheres
