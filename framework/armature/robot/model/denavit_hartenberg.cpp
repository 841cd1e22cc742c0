// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/denavit_hartenberg.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "armature/robot/model/joint_vector.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kGeometryRounding = 1e-14;  // [m], and the sine of an angle
constexpr double kSkew = 0.1;                // the least sine between two axes whose normal is used

/// A place on an axis, seen from the axis's own frame: Rz(angle) Tz(height).
struct OnAxis {
  double angle = 0, height = 0;  // [rad], [m]
};

/// The common normal of an axis (z of its frame) and the next one.
struct Normal {
  OnAxis from, to;          // its direction and feet, each seen from its axis's frame
  double a = 0, alpha = 0;  // [m], [rad] its length, and the turn about it
};

double angle_of(const Vector3d& v) { return std::atan2(v.y(), v.x()); }

/// Both axes parallel, or the same: the normal goes through the origin of the next axis.
Normal normal_of_parallels(const Isometry3d& T) {
  Vector3d offset = T.translation();
  offset.z() = 0;
  const double a = offset.norm();
  const Vector3d n = a > kGeometryRounding ? Vector3d{offset / a} : Vector3d::UnitX();
  return {.from = {angle_of(n), T.translation().z()},
          .to = {angle_of(T.linear().transpose() * n), 0},
          .a = a > kGeometryRounding ? a : 0,
          .alpha = T.linear()(2, 2) > 0 ? 0 : std::numbers::pi};
}

Normal normal_of_skew_axes(const Isometry3d& T, double sine) {
  const Vector3d u = T.linear().col(2), p = T.translation();
  Vector3d n = Vector3d::UnitZ().cross(u) / sine;
  if (n.dot(p) < -kGeometryRounding) n = -n;
  // p + t u is the foot on the next axis: seen along z, u is square to n.
  const double t = -p.head<2>().dot(u.head<2>()) / (sine * sine);
  return {.from = {angle_of(n), p.z() + t * u.z()},
          .to = {angle_of(T.linear().transpose() * n), t},
          .a = n.dot(p),
          .alpha = std::atan2(n.dot(Vector3d::UnitZ().cross(u)), u.z())};
}

/// None when the axes are nearly parallel.
std::optional<Normal> common_normal(const Isometry3d& T) {
  const double sine = T.linear().col(2).head<2>().norm();
  if (sine < kGeometryRounding) return normal_of_parallels(T);
  if (sine < kSkew) return std::nullopt;
  return normal_of_skew_axes(T, sine);
}

/// Of the base's x axis with the first joint's: none unless they meet at a right angle.
std::optional<Normal> normal_along_x(const Isometry3d& T) {
  const Vector3d u = T.linear().col(2), p = T.translation();
  const double t = -(p.y() * u.y() + p.z() * u.z());
  const Vector3d foot = p + t * u;
  if (std::abs(u.x()) > kGeometryRounding || foot.tail<2>().norm() > kGeometryRounding)
    return std::nullopt;
  return Normal{.from = {},
                .to = {angle_of(T.linear().transpose() * Vector3d::UnitX()), t},
                .a = foot.x(),
                .alpha = std::atan2(-u.y(), u.z())};
}

}  // namespace

std::vector<Isometry3d> to_denavit_hartenberg(std::span<const Isometry3d> before_T_axis,
                                              std::span<Joint> joints) {
  std::vector<Isometry3d> row_T_axis;
  std::optional<Normal> before;
  if (!joints.empty()) before = normal_along_x(before_T_axis[0]);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    std::optional<Normal> behind;
    if (i + 1 < joints.size()) behind = common_normal(before_T_axis[i + 1]);
    const Normal arriving = before.value_or(Normal{});
    const OnAxis leaving = behind.value_or(Normal{}).from;
    Joint& joint = joints[i];
    joint.placement.reset();
    if (!before) joint.placement = before_T_axis[i];
    joint.a = arriving.a;
    joint.alpha = arriving.alpha;
    joint.theta = wrap_angle(leaving.angle - arriving.to.angle);
    joint.d = leaving.height - arriving.to.height;
    row_T_axis.push_back(Eigen::Translation3d{0, 0, -leaving.height} *
                         Isometry3d{Eigen::AngleAxisd{-leaving.angle, Vector3d::UnitZ()}});
    before = behind;
  }
  return row_T_axis;
}

}  // namespace armature
