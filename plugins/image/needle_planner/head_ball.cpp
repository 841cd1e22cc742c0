// SPDX-License-Identifier: Apache-2.0
#include "head_ball.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "armature/volume/connected_parts.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

constexpr double kSkinHu = 0.5 * kAirHu, kMaxHu = 32767;

/// Voxels of `mask` within a ball become 0.
void clear_ball(const ForbiddenZone& ball, const Volume& volume, VoxelMask& mask) {
  const VolumeGeometry& geometry = volume.geometry;
  const Vector3d middle = geometry.index_of(ball.from);
  const Vector3d reach = ball.radius_m * geometry.spacing.cwiseInverse();
  Eigen::Vector3i low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = geometry.size[static_cast<std::size_t>(axis)] - 1;
    low[axis] = static_cast<int>(std::max(0.0, std::ceil(middle[axis] - reach[axis])));
    high[axis] = static_cast<int>(std::min<double>(last, std::floor(middle[axis] + reach[axis])));
  }
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const Vector3d point = geometry.point_at(Vector3d(i, j, k));
        if ((point - ball.from).norm() <= ball.radius_m) mask[volume.offset(i, j, k)] = 0;
      }
    }
  }
}

/// The ends of every row of voxels along x: the farthest point of a body from anywhere is one of
/// them.
std::vector<Vector3d> row_ends(const ConnectedPart& part, const VolumeGeometry& geometry) {
  const auto ny = static_cast<std::size_t>(geometry.size[1]);
  const auto nz = static_cast<std::size_t>(geometry.size[2]);
  struct RowEnds {
    int first = -1, last = -1;
  };
  std::vector<RowEnds> rows(ny * nz);
  for (const Eigen::Vector3i& at : part) {
    RowEnds& ends = rows[static_cast<std::size_t>(at[2]) * ny + static_cast<std::size_t>(at[1])];
    ends.first = ends.first < 0 ? at[0] : std::min(ends.first, at[0]);
    ends.last = std::max(ends.last, at[0]);
  }
  std::vector<Vector3d> points;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].first < 0) continue;
    for (const int i : {rows[row].first, rows[row].last}) {
      points.push_back(geometry.point_at(
          Vector3d(i, static_cast<double>(row % ny), static_cast<double>(row / ny))));
    }
  }
  return points;
}

/// M. Badoiu and K. L. Clarkson, "Smaller core-sets for balls", Symposium on Discrete Algorithms
/// 2003: the middle goes towards the farthest point, by ever smaller parts of the way; after n
/// steps the radius is at most 1 + 1 / sqrt(n) times the smallest.
ForbiddenZone ball_about(const std::vector<Vector3d>& points) {
  constexpr int kSteps = 1000;
  Vector3d middle = points.front();
  const auto farthest = [&] {
    return *std::ranges::max_element(
        points, {}, [&](const Vector3d& point) { return (point - middle).squaredNorm(); });
  };
  for (int step = 1; step <= kSteps; ++step) middle += (farthest() - middle) / (step + 1);
  return {"head", middle, middle, (farthest() - middle).norm()};
}

}  // namespace

Expected<ForbiddenZone> find_head(const Volume& volume, const std::vector<ForbiddenZone>& markers) {
  VoxelMask mask = voxels_between(volume, kSkinHu, kMaxHu);
  for (const ForbiddenZone& marker : markers) clear_ball(marker, volume, mask);
  const auto parts = connected_parts(std::move(mask), volume.geometry, 1, volume.voxels.size());
  if (parts.empty()) return refuse("no head was found in the volume: it is all air");
  const ConnectedPart& head = *std::ranges::max_element(parts, {}, &ConnectedPart::size);
  ForbiddenZone ball = ball_about(row_ends(head, volume.geometry));
  ball.radius_m += 0.5 * volume.geometry.spacing.norm();  // of the outermost voxels themselves
  return ball;
}

}  // namespace armature::image::needle_planner
