// SPDX-License-Identifier: Apache-2.0
#include "anatomy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "armature/volume/connected_parts.hpp"
#include "vessel_capsules.hpp"

namespace armature::image::needle_planner {
namespace {

constexpr double kDensest = 32767;
constexpr double kBeside = 0.01;  // [m] from a lesion it is told at most, beyond its radius

std::size_t voxels_of_ball(double diameter, const VolumeGeometry& geometry) {
  const double ball = std::numbers::pi / 6 * std::pow(diameter, 3);
  return static_cast<std::size_t>(std::ceil(ball / geometry.spacing.prod()));
}

void remove(const VoxelMask& what, VoxelMask& from) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (what[i] != 0) from[i] = 0;
  }
}

/// Each voxel the mean of itself and its 26 neighbours; the outermost ones stay. Noise becomes a
/// fifth.
Volume smoothed(const Volume& volume) {
  std::vector<std::int32_t> sums(volume.voxels.begin(), volume.voxels.end());
  std::size_t stride = 1;
  for (const int length : volume.geometry.size) {  // one axis after the other
    const auto n = static_cast<std::size_t>(length);
    const std::vector<std::int32_t> before = sums;
    for (std::size_t at = 0; at < sums.size(); ++at) {
      const std::size_t place = at / stride % n;
      const bool inside = place > 0 && place + 1 < n;
      sums[at] = inside ? before[at - stride] + before[at] + before[at + stride] : 3 * before[at];
    }
    stride *= n;
  }
  Volume result{volume.geometry, std::vector<std::int16_t>(sums.size())};
  std::ranges::transform(sums, result.voxels.begin(), [](std::int32_t sum) {
    return static_cast<std::int16_t>(std::lround(sum / 27.0));
  });
  return result;
}

/// [m] Of the ball of its volume.
double radius_of(const Lesion& lesion) {
  return std::cbrt(lesion.volume / (4.0 / 3 * std::numbers::pi));
}

std::string in_mm(const Eigen::Vector3d& point) {
  return fmt::format("({:.0f}, {:.0f}, {:.0f}) mm", 1e3 * point.x(), 1e3 * point.y(),
                     1e3 * point.z());
}

std::vector<ConnectedPart> vessel_parts(const Volume& volume, const Parameters& parameters) {
  VoxelMask vessels = voxels_between(volume, parameters.vessel_from, parameters.bone_from);
  const VoxelMask bone = voxels_between(volume, parameters.bone_from, kDensest);
  remove(dilated(bone, volume.geometry, 2), vessels);
  return connected_parts(vessels, volume.geometry,
                         voxels_of_ball(parameters.min_vessel, volume.geometry), vessels.size());
}

std::vector<Lesion> lesions_in(const Volume& volume, const Parameters& parameters) {
  VoxelMask dense = voxels_between(smoothed(volume), parameters.lesion_from, parameters.lesion_to);
  // What is a part of bone or of a vessel and a part of brain is as dense as a lesion.
  const VoxelMask bone = voxels_between(volume, parameters.bone_from, kDensest);
  remove(dilated(bone, volume.geometry, 3), dense);
  VoxelMask vessels(dense.size(), 0);
  for (const ConnectedPart& vessel : vessel_parts(volume, parameters)) {
    for (const Eigen::Vector3i& at : vessel) vessels[volume.offset(at[0], at[1], at[2])] = 1;
  }
  remove(dilated(vessels, volume.geometry, 3), dense);
  std::vector<Lesion> lesions;
  for (const ConnectedPart& part :
       connected_parts(dense, volume.geometry,
                       voxels_of_ball(parameters.min_lesion, volume.geometry), dense.size())) {
    lesions.push_back({volume.geometry.point_at(centroid(part)),
                       static_cast<double>(part.size()) * volume.geometry.spacing.prod()});
  }
  return lesions;
}

}  // namespace

Expected<Lesion> find_lesion(const Volume& volume, const Parameters& parameters) {
  const std::vector<Lesion> lesions = lesions_in(volume, parameters);
  if (lesions.empty()) {
    return refuse(
        fmt::format("no lesion was found: nothing of {:g} mm or more has {:g} to {:g} "
                    "Hounsfield units",
                    1e3 * parameters.min_lesion, parameters.lesion_from, parameters.lesion_to));
  }
  if (parameters.lesion_near.empty() && lesions.size() > 1) {
    return refuse(
        fmt::format("{} lesions were found, at {} and {}: which one is meant "
                    "(lesion_near_mm)?",
                    lesions.size(), in_mm(lesions[0].centre), in_mm(lesions[1].centre)));
  }
  if (parameters.lesion_near.empty()) return lesions.front();
  const Eigen::Vector3d near = Eigen::Vector3d::Map(parameters.lesion_near.data());
  const auto distance = [&](const Lesion& lesion) { return (lesion.centre - near).norm(); };
  const Lesion& nearest = *std::ranges::min_element(lesions, {}, distance);
  if (distance(nearest) > radius_of(nearest) + kBeside) {
    return refuse(
        fmt::format("no lesion was found at lesion_near_mm: the nearest one, at {}, is {:.0f} mm "
                    "away; the one that is meant may touch a vessel or bone",
                    in_mm(nearest.centre), 1e3 * distance(nearest)));
  }
  return nearest;
}

std::vector<ForbiddenZone> find_vessels(const Volume& volume, const Parameters& parameters) {
  std::vector<ForbiddenZone> zones;
  const auto parts = vessel_parts(volume, parameters);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3i& at : parts[i]) {
      points.push_back(volume.geometry.point_at(at.cast<double>()));
    }
    for (ForbiddenZone& zone : vessel_capsules(points, volume.geometry.spacing.prod())) {
      zone.name = fmt::format("vessel {}", i + 1);
      zones.push_back(std::move(zone));
    }
  }
  return zones;
}

}  // namespace armature::image::needle_planner
