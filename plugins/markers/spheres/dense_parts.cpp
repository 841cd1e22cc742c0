// SPDX-License-Identifier: Apache-2.0
#include "dense_parts.hpp"

#include <cstdint>

namespace armature::markers::spheres {
namespace {

class Flood {
 public:
  Flood(const Volume& volume, double threshold)
      : volume_{volume}, threshold_{threshold}, visited_(volume.voxels.size(), 0) {}

  bool is_new(int i, int j, int k) const {
    const auto& size = volume_.geometry.size;
    if (i < 0 || j < 0 || k < 0 || i >= size[0] || j >= size[1] || k >= size[2]) return false;
    const std::size_t at = volume_.offset(i, j, k);
    return visited_[at] == 0 && volume_.voxels[at] > threshold_;
  }

  DensePart fill_from(int i, int j, int k) {
    DensePart part{.low = {i, j, k}, .high = {i, j, k}};
    visit(i, j, k);
    while (!open_.empty()) {
      const Eigen::Vector3i at = open_.back();
      open_.pop_back();
      ++part.voxels;
      part.centroid += at.cast<double>();
      part.low = part.low.cwiseMin(at);
      part.high = part.high.cwiseMax(at);
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          Eigen::Vector3i next = at;
          next[axis] += step;
          if (is_new(next[0], next[1], next[2])) visit(next[0], next[1], next[2]);
        }
      }
    }
    part.centroid /= static_cast<double>(part.voxels);
    return part;
  }

 private:
  void visit(int i, int j, int k) {
    visited_[volume_.offset(i, j, k)] = 1;
    open_.emplace_back(i, j, k);
  }

  const Volume& volume_;
  double threshold_;
  std::vector<std::uint8_t> visited_;
  std::vector<Eigen::Vector3i> open_;
};

}  // namespace

std::vector<DensePart> dense_parts(const Volume& volume, double threshold, std::size_t max_voxels) {
  Flood flood{volume, threshold};
  std::vector<DensePart> parts;
  const auto& size = volume.geometry.size;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        if (!flood.is_new(i, j, k)) continue;
        const DensePart part = flood.fill_from(i, j, k);
        if (part.voxels <= max_voxels) parts.push_back(part);
      }
    }
  }
  return parts;
}

}  // namespace armature::markers::spheres
