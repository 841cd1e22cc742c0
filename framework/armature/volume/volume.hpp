// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// How the voxels of a volume lie in the image's frame: LPS as DICOM has it (x to the patient's
/// left, y to the back, z to the head), in metres.
struct VolumeGeometry {
  std::array<int, 3> size{0, 0, 0};                            // voxels along i, j, k
  Eigen::Vector3d spacing = Eigen::Vector3d::Constant(0.001);  // [m] along i, j, k
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();     // columns: i, j, k, unit, orthogonal
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();            // [m] centre of voxel (0, 0, 0)

  std::size_t count() const;
  /// Between places counted in voxels (whole numbers are centres) and points of the image [m].
  Eigen::Vector3d point_at(const Eigen::Vector3d& index) const;
  Eigen::Vector3d index_of(const Eigen::Vector3d& point) const;
  /// True where a voxel's value is known: between the centres of the outermost voxels.
  bool contains(const Eigen::Vector3d& point) const;
};

/// A volume of Hounsfield units (air -1000, water 0), i fastest, then j, then k.
struct Volume {
  VolumeGeometry geometry;
  std::vector<std::int16_t> voxels;

  std::size_t offset(int i, int j, int k) const {
    const auto& size = geometry.size;
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(i);
  }
  double at(int i, int j, int k) const { return voxels[offset(i, j, k)]; }
};

inline constexpr double kAirHu = -1000;

/// nullopt, or what makes it no volume: no voxels, another number of them than its size says, axes
/// that are not finite, not unit or not at right angles. A left-handed one is a volume. The first
/// line of every plugin that takes one.
std::optional<std::string> invalid_input(const Volume& volume);

/// The value at `point` of the image [m], between the eight nearest voxels (trilinear); of air
/// outside of what is known. Real-time safe.
double hounsfield_at(const Volume& volume, const Eigen::Vector3d& point);

}  // namespace armature
