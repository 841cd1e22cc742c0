// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/visualization_msgs.hpp"
#include "armature/values/time.hpp"
#include "robot_shape.hpp"

namespace armature::monitor::rviz {

// The numbers of visualization_msgs/Marker.
enum class MarkerType {
  arrow = 0,
  cube = 1,
  sphere = 2,
  cylinder = 3,
  line_strip = 4,
  sphere_list = 7,
  triangle_list = 11
};
enum class MarkerAction { add = 0, remove = 2, remove_all = 3 };

/// Red, green, blue and opacity, 0..1.
struct Color {
  float r = 1, g = 1, b = 1, a = 1;
};

/// What every marker says. A marker replaces the one of the same name and id.
struct MarkerHead {
  std::string ns;
  int id = 0;
  std::string frame;
  Time stamp;
  bool rides =
      false;  // on its frame, wherever that goes; else it is placed where that was at stamp
  Color color;
};

// Every one of these is complete: a unit orientation, a scale above zero, no field left over from
// another marker. Lengths in metres, points in the head's frame.

/// A cylinder (a bar) round the segment; one without length is drawn a tenth of a millimetre long.
msg::Marker cylinder(const MarkerHead& head, const Segment& axis, double radius);
msg::Marker bar(const MarkerHead& head, const Segment& axis, double width);
msg::Marker sphere(const MarkerHead& head, const Eigen::Vector3d& center, double diameter);
msg::Marker spheres(const MarkerHead& head, std::span<const Eigen::Vector3d> centers,
                    double diameter);
msg::Marker arrow(const MarkerHead& head, const Segment& shaft, double diameter);
/// Needs two points.
msg::Marker line_strip(const MarkerHead& head, const std::vector<msg::Point>& points, double width);
/// From its tip to the middle of its mouth.
msg::Marker cone(const MarkerHead& head, const Segment& axis, double half_angle);
/// Takes the marker away.
msg::Marker removal(const MarkerHead& head);
/// Takes all markers of the topic away: the first of an array that says everything anew.
msg::Marker removal_of_all(const MarkerHead& head);

}  // namespace armature::monitor::rviz
