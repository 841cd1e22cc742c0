// SPDX-License-Identifier: Apache-2.0
#include "crossing.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

/// How far along a line skull and skin end [m].
struct Ends {
  double skull, skin;
};

/// Soft tissue behind air, in one piece along a line [m]: a scalp. A marker's edges show less.
constexpr double kScalp = 0.002;
constexpr double kSkin = 0.5 * kAirHu;
constexpr double kFarthest = 0.3;  // [m]

/// Whether the line goes on through soft tissue behind the air at `from_t` [m]: that was a cavity.
bool tissue_follows(const Volume& volume, const Vector3d& from, const Vector3d& direction,
                    double bone_from, double from_t) {
  const double step = 0.25 * volume.geometry.spacing.minCoeff();
  double soft = 0;
  for (double t = from_t; t < kFarthest; t += step) {
    const Vector3d point = from + t * direction;
    if (!volume.geometry.contains(point)) return false;
    const double value = hounsfield_at(volume, point);
    soft = value > kSkin && value < 0.5 * bone_from ? soft + step : 0;
    if (soft > kScalp) return true;
  }
  return false;
}

std::optional<Ends> ends_along(const Volume& volume, const Vector3d& from,
                               const Vector3d& direction, double bone_from,
                               const std::vector<ForbiddenZone>& markers) {
  constexpr double kMarrow = 0.008;  // [m] between the two tables of one skull, at most
  const double step = 0.25 * volume.geometry.spacing.minCoeff();
  std::optional<double> skull;
  double before = hounsfield_at(volume, from);
  for (double t = step; t < kFarthest; t += step) {
    const Vector3d point = from + t * direction;
    if (!volume.geometry.contains(point)) return std::nullopt;  // the scan ends within the head
    const double value = hounsfield_at(volume, point);
    const auto falls_below = [&](double level) { return before > level && value <= level; };
    const auto place = [&](double level) { return t - step * (level - value) / (before - value); };
    const auto is_marker = [&] {
      return std::ranges::any_of(
          markers, [&](const auto& marker) { return clearance(point, point, marker) < 0; });
    };
    const bool bone_begins = before <= bone_from && value > bone_from;
    if (skull && bone_begins && t - *skull > kMarrow && !is_marker()) return std::nullopt;
    if (falls_below(bone_from) && !(skull && is_marker())) skull = place(bone_from);
    if (skull && falls_below(kSkin)) {
      if (tissue_follows(volume, from, direction, bone_from, t)) return std::nullopt;
      return Ends{*skull, place(kSkin)};
    }
    before = value;
  }
  return std::nullopt;
}

/// Of the plane that is nearest to points.
Vector3d normal_of(const std::vector<Vector3d>& points) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& point : points) middle += point / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& point : points) {
    scatter += (point - middle) * (point - middle).transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{scatter}.eigenvectors().col(0);
}

}  // namespace

std::optional<Crossing> crossing_of(const Volume& volume, const Vector3d& target,
                                    const Vector3d& direction, double bone_from,
                                    const std::vector<ForbiddenZone>& markers) {
  const auto ends = ends_along(volume, target, direction, bone_from, markers);
  if (!ends) return std::nullopt;
  constexpr double kAside = 0.003;  // [m]
  constexpr int kLines = 8, kEnough = 6;
  const Vector3d across = direction.unitOrthogonal(), third = direction.cross(across);
  std::vector<Vector3d> around;
  for (int i = 0; i < kLines; ++i) {
    const double angle = 2 * std::numbers::pi * i / kLines;
    const Vector3d from = target + kAside * (std::cos(angle) * across + std::sin(angle) * third);
    const auto beside = ends_along(volume, from, direction, bone_from, markers);
    if (beside) around.push_back(from + beside->skull * direction);
  }
  if (around.size() < kEnough) return std::nullopt;
  return Crossing{
      .skin = target + ends->skin * direction,
      .skull = target + ends->skull * direction,
      .skull_angle = std::acos(std::min(1.0, std::abs(normal_of(around).dot(direction))))};
}

}  // namespace armature::image::needle_planner
