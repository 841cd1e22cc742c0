// SPDX-License-Identifier: Apache-2.0
#include "spheres.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include "armature/runtime/plugins/plugin.hpp"
#include "armature/volume/connected_parts.hpp"
#include "sphere_surface.hpp"

namespace armature::markers::spheres {
namespace {

/// Of a ball in voxels.
double voxels_of(double radius, const VolumeGeometry& geometry) {
  return 4.0 / 3 * std::numbers::pi * std::pow(radius, 3) / geometry.spacing.prod();
}

/// Nearly as wide along every axis as a ball is.
bool is_as_wide(const ConnectedPart& part, double radius, const VolumeGeometry& geometry) {
  Eigen::Vector3i low = part.front(), high = low;
  for (const Eigen::Vector3i& voxel : part) {
    low = low.cwiseMin(voxel);
    high = high.cwiseMax(voxel);
  }
  const Eigen::Array3d off =
      (high - low).cast<double>().array() * geometry.spacing.array() - 2 * radius;
  return (off.abs() < 0.6 * radius + 2 * geometry.spacing.array()).all();
}

std::optional<FoundMarker> ball_at(const Volume& volume, Eigen::Vector3d centre, double radius) {
  const VolumeGeometry& geometry = volume.geometry;
  FittedSphere sphere;
  for (int round = 0; round < 3; ++round) {  // directions are best from the centre itself
    const auto points = surface_points(volume, centre, radius);
    if (points.empty()) return std::nullopt;
    sphere = fitted_sphere(points, centre, radius);
    centre = sphere.centre;
  }
  const double voxel = std::cbrt(geometry.spacing.prod());
  // Neighbouring points lie in the same voxels and err together: as many count as the surface has
  // voxels.
  constexpr double kPoints = 400;
  // What is stuck to the skin is pulled by it, however many points there are.
  const double pulled = 0.01 * geometry.spacing.maxCoeff();
  const double independent = 4 * std::numbers::pi * radius * radius / (voxel * voxel);
  const double together = std::sqrt(std::max(1.0, kPoints / independent));
  return FoundMarker{
      .centre = centre,
      .radius = sphere.radius,
      .sigma = std::hypot(sphere.rms * sphere.spread * together, pulled),
      .confidence = std::max(0.0, 1 - sphere.rms / (0.5 * geometry.spacing.maxCoeff()))};
}

}  // namespace

Expected<std::vector<FoundMarker>> Spheres::find(const Volume& volume) const {
  if (auto wrong = invalid_input(volume)) return refuse(std::move(*wrong));
  const double whole = voxels_of(parameters_.radius, volume.geometry);
  std::vector<FoundMarker> found;
  for (const ConnectedPart& part : connected_parts(
           voxels_between(volume, parameters_.threshold, 32767), volume.geometry,
           static_cast<std::size_t>(0.3 * whole), static_cast<std::size_t>(2 * whole))) {
    if (!is_as_wide(part, parameters_.radius, volume.geometry)) continue;
    const auto ball = ball_at(volume, volume.geometry.point_at(centroid(part)), parameters_.radius);
    if (ball && ball->confidence >= parameters_.min_confidence && ball->confidence > 0 &&
        std::abs(ball->radius - parameters_.radius) <= parameters_.radius_tolerance) {
      found.push_back(*ball);
    }
  }
  std::ranges::sort(found, {}, [](const FoundMarker& marker) {
    return std::tuple{marker.centre.z(), marker.centre.y(), marker.centre.x()};
  });
  return found;
}

}  // namespace armature::markers::spheres

ARMATURE_PLUGIN(armature::markers::spheres::Spheres);
