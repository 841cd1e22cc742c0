// SPDX-License-Identifier: Apache-2.0
#include "swing.hpp"

#include <cmath>

namespace armature::path::mouth_arc {
namespace {

constexpr double kParallel = 1e-9;  // sine below which two unit vectors span no plane

/// A unit vector square to `unit`, in the plane that it spans with +z where there is one.
Eigen::Vector3d towards_top(const Eigen::Vector3d& unit) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - unit.z() * unit;
  return up.norm() > kParallel ? up.normalized() : Eigen::Vector3d::UnitX();
}

}  // namespace

double View::miss_angle() const { return 2 * std::asin(std::min(1.0, 0.5 * miss.norm())); }

View view_of(const Eigen::Vector3d& focus, const Eigen::Vector3d& position,
             const Eigen::Vector3d& direction) {
  View view;
  view.distance = (position - focus).norm();
  view.outward = (position - focus) / view.distance;
  view.miss = direction.normalized() + view.outward;
  return view;
}

Swing::Swing(const Eigen::Vector3d& focus, const View& from, const View& to)
    : focus_{focus}, from_{from}, to_{to} {
  const Eigen::Vector3d normal = from.outward.cross(to.outward);
  angle_ = std::atan2(normal.norm(), from.outward.dot(to.outward));
  axis_ = normal.norm() > kParallel ? normal.normalized()
                                    : from.outward.cross(towards_top(from.outward)).normalized();
}

Eigen::Vector3d Swing::outward(double s) const {
  return Eigen::AngleAxisd{s * angle_, axis_} * from_.outward;
}

Eigen::Vector3d Swing::position(double s) const {
  return focus_ + ((1 - s) * from_.distance + s * to_.distance) * outward(s);
}

Eigen::Vector3d Swing::direction(double s) const {
  const Eigen::Vector3d miss = (1 - s) * (Eigen::AngleAxisd{s * angle_, axis_} * from_.miss) +
                               s * (Eigen::AngleAxisd{(s - 1) * angle_, axis_} * to_.miss);
  return (miss - outward(s)).normalized();
}

}  // namespace armature::path::mouth_arc
