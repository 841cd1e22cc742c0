// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace armature {

std::size_t VolumeGeometry::count() const {
  std::size_t product = 1;
  for (const int n : size) product *= static_cast<std::size_t>(std::max(n, 0));
  return product;
}

Eigen::Vector3d VolumeGeometry::point_at(const Eigen::Vector3d& index) const {
  return origin + direction * index.cwiseProduct(spacing);
}

Eigen::Vector3d VolumeGeometry::index_of(const Eigen::Vector3d& point) const {
  return (direction.transpose() * (point - origin)).cwiseQuotient(spacing);
}

bool VolumeGeometry::contains(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d index = index_of(point);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(index[axis] >= 0 && index[axis] <= size[static_cast<std::size_t>(axis)] - 1))
      return false;
  }
  return true;
}

std::optional<std::string> invalid_input(const Volume& volume) {
  const VolumeGeometry& geometry = volume.geometry;
  const auto& size = geometry.size;
  if (geometry.count() == 0) return "a volume without voxels";
  if (volume.voxels.size() != geometry.count()) {
    return fmt::format("a volume of {} x {} x {} voxels with {} values", size[0], size[1], size[2],
                       volume.voxels.size());
  }
  const bool finite =
      geometry.spacing.allFinite() && geometry.direction.allFinite() && geometry.origin.allFinite();
  if (!finite || geometry.spacing.minCoeff() <= 0) {
    return "a volume whose spacing or place is no length";
  }
  constexpr double kRounding = 1e-4;  // files tell directions with few digits
  const Eigen::Matrix3d off =
      geometry.direction.transpose() * geometry.direction - Eigen::Matrix3d::Identity();
  if (off.cwiseAbs().maxCoeff() > kRounding) return "a volume whose axes are not at right angles";
  return std::nullopt;
}

double hounsfield_at(const Volume& volume, const Eigen::Vector3d& point) {
  if (!volume.geometry.contains(point)) return kAirHu;
  const Eigen::Vector3d index = volume.geometry.index_of(point);
  std::array<int, 3> low{}, high{};
  Eigen::Vector3d part;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    low[a] = static_cast<int>(index[axis]);
    high[a] = std::min(low[a] + 1, volume.geometry.size[a] - 1);
    part[axis] = index[axis] - low[a];
  }
  const auto row = [&](int j, int k) {
    return volume.at(low[0], j, k) * (1 - part[0]) + volume.at(high[0], j, k) * part[0];
  };
  const auto slice = [&](int k) {
    return row(low[1], k) * (1 - part[1]) + row(high[1], k) * part[1];
  };
  return slice(low[2]) * (1 - part[2]) + slice(high[2]) * part[2];
}

}  // namespace armature
