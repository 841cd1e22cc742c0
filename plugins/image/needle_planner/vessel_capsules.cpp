// SPDX-License-Identifier: Apache-2.0
#include "vessel_capsules.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

struct Axis {
  Vector3d middle, direction;

  double along(const Vector3d& point) const { return (point - middle).dot(direction); }
  double across(const Vector3d& point) const { return (point - middle).cross(direction).norm(); }
};

Axis principal_axis(const std::vector<Vector3d>& points) {
  const double n = static_cast<double>(points.size());
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& point : points) middle += point / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& point : points) {
    scatter += (point - middle) * (point - middle).transpose() / n;
  }
  return {middle, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{scatter}.eigenvectors().col(2)};
}

void add_capsules(const std::vector<Vector3d>& points, double voxel_volume, int splits,
                  std::vector<ForbiddenZone>& capsules) {
  const Axis axis = principal_axis(points);
  double low = std::numeric_limits<double>::infinity(), high = -low, radius = 0;
  for (const Vector3d& point : points) {
    low = std::min(low, axis.along(point));
    high = std::max(high, axis.along(point));
    radius = std::max(radius, axis.across(point));
  }
  const double volume = voxel_volume * static_cast<double>(points.size());
  const double straight = std::sqrt(volume / (std::numbers::pi * std::max(high - low, 1e-6)));
  constexpr double kBent = 1.5;  // times the radius of a straight one
  if (splits > 0 && points.size() > 100 && high - low > 3 * straight && radius > kBent * straight) {
    std::vector<Vector3d> first, second;
    for (const Vector3d& point : points) {
      (axis.along(point) < 0.5 * (low + high) ? first : second).push_back(point);
    }
    add_capsules(first, voxel_volume, splits - 1, capsules);
    add_capsules(second, voxel_volume, splits - 1, capsules);
    return;
  }
  // Ends are round: a capsule's line is shorter than it. Points at the corners of an end lie
  // outside of that, so the radius grows until none does.
  const double shortened = std::min(radius, 0.5 * (high - low));
  ForbiddenZone capsule{.name = {},
                        .from = axis.middle + (low + shortened) * axis.direction,
                        .to = axis.middle + (high - shortened) * axis.direction,
                        .radius_m = 0};
  for (const Vector3d& point : points) {
    capsule.radius_m =
        std::max(capsule.radius_m, clearance(point, point, capsule) + capsule.radius_m);
  }
  capsules.push_back(capsule);
}

}  // namespace

std::vector<ForbiddenZone> vessel_capsules(const std::vector<Vector3d>& points,
                                           double voxel_volume) {
  std::vector<ForbiddenZone> capsules;
  constexpr int kSplits = 5;  // at most 32 pieces
  if (!points.empty()) add_capsules(points, voxel_volume, kSplits, capsules);
  return capsules;
}

}  // namespace armature::image::needle_planner
