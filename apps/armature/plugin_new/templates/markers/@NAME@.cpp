#include <algorithm>
#include <cmath>
#include <numbers>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/markers/markers.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
/// A voxel has mass by how much denser than bone it is.
class @CLASS@ final : public MarkerFinder {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<std::vector<FoundMarker>> find(const Volume& volume) const override {
    if (auto wrong = invalid_input(volume)) return refuse(*wrong);
    const auto& [nx, ny, nz] = volume.geometry.size;
    std::vector<char> seen(volume.voxels.size(), 0);
    std::vector<FoundMarker> found;
    for (int k = 0; k < nz; ++k) {
      for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) add_part(volume, {i, j, k}, seen, found);
      }
    }
    return found;
  }
  double marker_radius() const override { return parameters_.radius; }

 private:
  double mass(double hounsfield) const {
    const double bone = parameters_.bone, ball = parameters_.ball;
    return std::clamp((hounsfield - bone) / (ball - bone), 0.0, 1.0);
  }
  /// The part that begins at a voxel, when it is about a ball.
  void add_part(const Volume& volume, const Eigen::Vector3i& first, std::vector<char>& seen,
                std::vector<FoundMarker>& found) const {
    const VolumeGeometry& geometry = volume.geometry;
    double sum = 0;
    Eigen::Vector3d centre{0, 0, 0}, low = first.cast<double>(), high = low;
    std::vector<Eigen::Vector3i> open{first};
    while (!open.empty()) {
      const Eigen::Vector3i at = open.back();
      open.pop_back();
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis)
        inside = inside && at[axis] >= 0 && at[axis] < geometry.size[static_cast<std::size_t>(axis)];
      if (!inside) continue;
      const std::size_t voxel = volume.offset(at[0], at[1], at[2]);
      const double m = mass(volume.voxels[voxel]);
      if (m < 0.1 || seen[voxel]) continue;
      seen[voxel] = 1;
      sum += m;
      centre += m * at.cast<double>();
      low = low.cwiseMin(at.cast<double>());
      high = high.cwiseMax(at.cast<double>());
      for (int axis = 0; axis < 3; ++axis) {
        open.push_back(at + Eigen::Vector3i::Unit(axis));
        open.push_back(at - Eigen::Vector3i::Unit(axis));
      }
    }
    if (sum == 0) return;
    const double cubic = sum * geometry.spacing.prod() * 3 / (4 * std::numbers::pi);
    const double radius = std::cbrt(cubic);
    const Eigen::Vector3d off =
        (high - low).cwiseProduct(geometry.spacing).array() - 2 * parameters_.radius;
    const bool round = (off.array().abs() < 0.6 * parameters_.radius + geometry.spacing.array()).all();
    if (!round || std::abs(radius / parameters_.radius - 1) > 0.1) return;
    found.push_back({.centre = geometry.point_at(centre / sum),
                     .radius = radius,
                     .sigma = 0.04 * geometry.spacing.maxCoeff(),
                     .confidence = 1 - std::abs(radius / parameters_.radius - 1)});
  }

  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
