// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/phantom.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace armature {
namespace {

using Eigen::Vector3d;

/// What is asked of a solid for every voxel: `depth` [m] is above 0 inside, and its amount is at
/// most the distance from the surface.
struct Body {
  explicit Body(const Solid& solid) : hounsfield{solid.hounsfield} {
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&solid.shape)) {
      a = ellipsoid->centre;
      inverse_axes = ellipsoid->semi_axes.cwiseInverse();
      size = ellipsoid->semi_axes.minCoeff();
      low = a - ellipsoid->semi_axes;
      high = a + ellipsoid->semi_axes;
      return;
    }
    const auto& capsule = std::get<Capsule>(solid.shape);
    is_capsule = true;
    a = capsule.from;
    along = capsule.to - capsule.from;
    size = capsule.radius;
    low = capsule.from.cwiseMin(capsule.to) - Vector3d::Constant(size);
    high = capsule.from.cwiseMax(capsule.to) + Vector3d::Constant(size);
  }

  double depth(const Vector3d& point) const {
    if (!is_capsule) return size * (1 - (point - a).cwiseProduct(inverse_axes).norm());
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return size - (point - a - t * along).norm();
  }

  double hounsfield;
  bool is_capsule = false;
  Vector3d a, along, inverse_axes, low, high;
  double size = 0;
};

/// Of those bodies that a row of voxels may meet, the last first.
class Row {
 public:
  void clear() { bodies_.clear(); }
  void add(const Body& body) { bodies_.push_back(&body); }

  double value_at(const Vector3d& point) const {
    for (const Body* body : bodies_) {
      if (body->depth(point) >= 0) return body->hounsfield;
    }
    return kAirHu;
  }
  /// True when a surface may come within `reach` [m] of `point`; else `value` is the value there.
  bool is_mixed(const Vector3d& point, double reach, double& value) const {
    value = kAirHu;
    for (const Body* body : bodies_) {
      const double depth = body->depth(point);
      if (std::abs(depth) <= reach) return true;
      if (depth > 0) {
        value = body->hounsfield;
        return false;
      }
    }
    return false;
  }

 private:
  std::vector<const Body*> bodies_;
};

/// From the centre of a voxel to the points at which it is looked at.
std::vector<Vector3d> offsets_of(const VolumeGeometry& geometry, int points_per_side) {
  std::vector<Vector3d> offsets;
  const int n = std::max(points_per_side, 1);
  const auto place = [&](int i) { return (i + 0.5) / n - 0.5; };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Vector3d part{place(i), place(j), place(k)};
        offsets.push_back(geometry.direction * part.cwiseProduct(geometry.spacing));
      }
    }
  }
  return offsets;
}

std::int16_t rounded(double value) {
  using Limits = std::numeric_limits<std::int16_t>;
  return static_cast<std::int16_t>(
      std::clamp(std::round(value), double{Limits::min()}, double{Limits::max()}));
}

}  // namespace

Volume scanned(std::span<const Solid> solids, const VolumeGeometry& geometry,
               const Scanner& scanner) {
  const std::vector<Body> bodies{solids.begin(), solids.end()};
  const std::vector<Vector3d> offsets = offsets_of(geometry, scanner.points_per_side);
  const double reach = 0.5 * geometry.spacing.norm();
  std::mt19937_64 random{scanner.seed};
  std::normal_distribution<double> noise{0, std::max(scanner.noise_hu, 1e-300)};
  Volume volume{geometry, std::vector<std::int16_t>(geometry.count())};
  auto voxel = volume.voxels.begin();
  Row row;
  const Vector3d step = geometry.direction.col(0) * geometry.spacing.x();
  for (int k = 0; k < geometry.size[2]; ++k) {
    for (int j = 0; j < geometry.size[1]; ++j) {
      const Vector3d first = geometry.point_at({0, double(j), double(k)});
      const Vector3d last = first + (geometry.size[0] - 1) * step;
      const Vector3d low = first.cwiseMin(last).array() - reach;
      const Vector3d high = first.cwiseMax(last).array() + reach;
      row.clear();
      for (auto body = bodies.rbegin(); body != bodies.rend(); ++body) {
        if ((body->low.array() <= high.array()).all() &&
            (body->high.array() >= low.array()).all()) {
          row.add(*body);
        }
      }
      for (int i = 0; i < geometry.size[0]; ++i, ++voxel) {
        const Vector3d centre = first + i * step;
        double value = kAirHu;
        if (row.is_mixed(centre, reach, value)) {
          value = 0;
          for (const Vector3d& offset : offsets) value += row.value_at(centre + offset);
          value /= static_cast<double>(offsets.size());
        }
        *voxel = rounded(scanner.noise_hu > 0 ? value + noise(random) : value);
      }
    }
  }
  return volume;
}

}  // namespace armature
