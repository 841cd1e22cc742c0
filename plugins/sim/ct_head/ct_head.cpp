// SPDX-License-Identifier: Apache-2.0
#include "ct_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "armature/kinds/geometry_params.hpp"
#include "armature/volume/phantom.hpp"

namespace armature::sim::ct_head {
namespace {

using Eigen::Vector3d;

// Hounsfield units of a head with contrast agent; markers are of glass.
constexpr double kSkin = 40, kBone = 1000, kBrain = 35, kVessel = 250, kLesion = 100,
                 kMarker = 2500;
constexpr double kMargin = 0.005;   // [m] of air about everything
constexpr double kFarthest = 0.25;  // [m] from the middle of a head

bool is_in_a_head(const Vector3d& point) { return (point.array().abs() < kFarthest).all(); }

std::vector<Vector3d> worn(const Anatomy& anatomy, const Parameters& parameters) {
  const std::size_t count = anatomy.markers.size();
  const std::size_t lost = std::min(count, static_cast<std::size_t>(parameters.lost_markers));
  return {anatomy.markers.begin(), anatomy.markers.end() - static_cast<std::ptrdiff_t>(lost)};
}

std::vector<Solid> solids_of(const Anatomy& anatomy, const Parameters& parameters) {
  const Vector3d skin = vector_of(parameters.head);
  const auto shell = [&](double below, double hounsfield) {
    const Vector3d axes = (skin.array() - below).max(1e-3);
    return Solid{Ellipsoid{Vector3d::Zero(), axes}, hounsfield};
  };
  std::vector<Solid> solids{shell(0, kSkin), shell(parameters.scalp, kBone),
                            shell(parameters.scalp + parameters.skull, kBrain)};
  for (const ForbiddenZone& vessel : anatomy.vessels) {
    solids.push_back({Capsule{vessel.from, vessel.to, vessel.radius_m}, kVessel});
  }
  solids.push_back(ball(anatomy.lesion, parameters.lesion_radius, kLesion));
  for (const Vector3d& marker : worn(anatomy, parameters)) {
    solids.push_back(ball(marker, parameters.marker_radius, kMarker));
  }
  return solids;
}

/// About the middle of the head, so that a mirrored volume is as large.
VolumeGeometry field_of_view(const Anatomy& anatomy, const Parameters& parameters) {
  Vector3d half = vector_of(parameters.head);
  for (const Vector3d& marker : anatomy.markers) {
    half = half.cwiseMax((marker.array().abs() + parameters.marker_radius).matrix());
  }
  half.array() += kMargin;
  VolumeGeometry geometry{.spacing = vector_of(parameters.voxel)};
  for (int axis = 0; axis < 3; ++axis) {
    const int steps = static_cast<int>(std::ceil(2 * half[axis] / geometry.spacing[axis]));
    geometry.size[static_cast<std::size_t>(axis)] = steps + 1;
    geometry.origin[axis] = -0.5 * steps * geometry.spacing[axis];
  }
  return geometry;
}

void mirror_rows(Volume& volume) {
  const std::ptrdiff_t length = volume.geometry.size[0];
  for (auto row = volume.voxels.begin(); row != volume.voxels.end(); row += length) {
    std::reverse(row, row + length);
  }
}

}  // namespace

Expected<Volume> scan(const Anatomy& anatomy, const Parameters& parameters, std::uint64_t seed) {
  bool in_a_head = is_in_a_head(anatomy.lesion);
  for (const Vector3d& marker : anatomy.markers) in_a_head = in_a_head && is_in_a_head(marker);
  for (const ForbiddenZone& vessel : anatomy.vessels) {
    if (auto wrong = defect(vessel)) return refuse(*wrong);
    in_a_head = in_a_head && is_in_a_head(vessel.from) && is_in_a_head(vessel.to);
  }
  if (!in_a_head) {
    return refuse(
        fmt::format("a marker, the lesion or a vessel is not within {:g} mm of the "
                    "middle of the head",
                    1e3 * kFarthest));
  }
  Volume volume = scanned(
      solids_of(anatomy, parameters), field_of_view(anatomy, parameters),
      {.points_per_side = parameters.points_per_side, .noise_hu = parameters.noise, .seed = seed});
  if (parameters.mirrored) mirror_rows(volume);
  return volume;
}

}  // namespace armature::sim::ct_head
