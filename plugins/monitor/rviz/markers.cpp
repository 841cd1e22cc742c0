// SPDX-License-Identifier: Apache-2.0
#include "markers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kShortest = 1e-4;  // [m] a scale of zero is an error to RViz

msg::Marker begin(const MarkerHead& head, MarkerType type, MarkerAction action,
                  const Vector3d& scale) {
  msg::Marker marker;
  write_header(marker.header_(), head.stamp, head.frame);
  marker.ns_(head.ns);
  marker.id_(head.id);
  marker.type_(static_cast<int>(type));
  marker.action_(static_cast<int>(action));
  assign(marker.pose_().orientation_(), Quaterniond::Identity());
  assign(marker.scale_(), scale);
  marker.color_().r_(head.color.r);
  marker.color_().g_(head.color.g);
  marker.color_().b_(head.color.b);
  marker.color_().a_(head.color.a);
  marker.frame_locked_(head.rides);
  return marker;
}

/// Some rotation that turns z into `along`.
Quaterniond with_z_along(const Vector3d& along) {
  Eigen::Matrix3d axes;
  axes.col(2) = along.normalized();
  axes.col(0) = along.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Quaterniond{axes};
}

/// Of a solid whose axis is its own z.
msg::Marker solid(const MarkerHead& head, MarkerType type, const Segment& axis, double width) {
  const Vector3d along = axis.to - axis.from;
  msg::Marker marker =
      begin(head, type, MarkerAction::add, {width, width, std::max(along.norm(), kShortest)});
  assign(marker.pose_().position_(), Vector3d{0.5 * (axis.from + axis.to)});
  if (along.norm() > 0) {
    assign(marker.pose_().orientation_(), with_z_along(along));
  }
  return marker;
}

void add_point(msg::Marker& marker, const Vector3d& point) {
  assign(marker.points_().emplace_back(), point);
}

}  // namespace

msg::Marker cylinder(const MarkerHead& head, const Segment& axis, double radius) {
  return solid(head, MarkerType::cylinder, axis, 2 * radius);
}

msg::Marker bar(const MarkerHead& head, const Segment& axis, double width) {
  return solid(head, MarkerType::cube, axis, width);
}

msg::Marker sphere(const MarkerHead& head, const Vector3d& center, double diameter) {
  msg::Marker marker =
      begin(head, MarkerType::sphere, MarkerAction::add, Vector3d::Constant(diameter));
  assign(marker.pose_().position_(), center);
  return marker;
}

msg::Marker spheres(const MarkerHead& head, std::span<const Vector3d> centers, double diameter) {
  msg::Marker marker =
      begin(head, MarkerType::sphere_list, MarkerAction::add, Vector3d::Constant(diameter));
  for (const Vector3d& center : centers) add_point(marker, center);
  return marker;
}

msg::Marker arrow(const MarkerHead& head, const Segment& shaft, double diameter) {
  // With two points: shaft diameter, head diameter, head length.
  msg::Marker marker =
      begin(head, MarkerType::arrow, MarkerAction::add, {diameter, 2 * diameter, 3 * diameter});
  add_point(marker, shaft.from);
  add_point(marker, shaft.to);
  return marker;
}

msg::Marker line_strip(const MarkerHead& head, const std::vector<msg::Point>& points,
                       double width) {
  msg::Marker marker = begin(head, MarkerType::line_strip, MarkerAction::add, {width, 0, 0});
  marker.points_() = points;
  return marker;
}

msg::Marker cone(const MarkerHead& head, const Segment& axis, double half_angle) {
  constexpr int kSides = 24;
  msg::Marker marker = begin(head, MarkerType::triangle_list, MarkerAction::add, Vector3d::Ones());
  const Vector3d along = axis.to - axis.from;
  const double radius = along.norm() * std::tan(half_angle);
  const Vector3d side = radius * along.unitOrthogonal();
  const Vector3d up = along.normalized().cross(side);
  const auto rim = [&](int i) -> Vector3d {
    const double angle = 2 * std::numbers::pi * i / kSides;
    return axis.to + std::cos(angle) * side + std::sin(angle) * up;
  };
  for (int i = 0; i < kSides; ++i) {
    add_point(marker, axis.from);
    add_point(marker, rim(i + 1));
    add_point(marker, rim(i));
  }
  return marker;
}

msg::Marker removal(const MarkerHead& head) {
  return begin(head, MarkerType::arrow, MarkerAction::remove, Vector3d::Ones());
}

msg::Marker removal_of_all(const MarkerHead& head) {
  return begin(head, MarkerType::arrow, MarkerAction::remove_all, Vector3d::Ones());
}

}  // namespace armature::monitor::rviz
