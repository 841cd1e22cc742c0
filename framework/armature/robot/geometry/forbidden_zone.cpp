// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/forbidden_zone.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace armature {
namespace {

using Eigen::Vector3d;

/// Where on the segment from `a` along `d` the nearest point to `p` is, from 0 to 1.
double nearest(const Vector3d& a, const Vector3d& d, const Vector3d& p) {
  const double length2 = d.squaredNorm();
  return length2 > 0 ? std::clamp(d.dot(p - a) / length2, 0.0, 1.0) : 0.0;
}

double distance(const Vector3d& p, const Vector3d& a, const Vector3d& d) {
  return (a + nearest(a, d, p) * d - p).norm();
}

/// Between two segments: at an end of one of them, or where both lines are nearest.
double distance(const Vector3d& a, const Vector3d& d, const Vector3d& c, const Vector3d& e) {
  double least = std::min(
      {distance(a, c, e), distance(a + d, c, e), distance(c, a, d), distance(c + e, a, d)});
  const Vector3d normal = d.cross(e), between = c - a;
  const double n2 = normal.squaredNorm();
  if (!(n2 > 0)) return least;
  const double s = between.cross(e).dot(normal) / n2, t = between.cross(d).dot(normal) / n2;
  if (s > 0 && s < 1 && t > 0 && t < 1) {
    least = std::min(least, std::abs(between.dot(normal)) / std::sqrt(n2));
  }
  return least;
}

}  // namespace

std::optional<std::string> defect(const ForbiddenZone& zone) {
  if (!zone.from.allFinite() || !zone.to.allFinite()) {
    return fmt::format("forbidden zone '{}' is not finite", zone.name);
  }
  if (!(zone.radius_m >= 0 && std::isfinite(zone.radius_m))) {
    return fmt::format("forbidden zone '{}' has the radius {} m", zone.name, zone.radius_m);
  }
  return std::nullopt;
}

double clearance(const Vector3d& a, const Vector3d& b, const ForbiddenZone& zone) {
  return distance(a, b - a, zone.from, zone.to - zone.from) - zone.radius_m;
}

}  // namespace armature
