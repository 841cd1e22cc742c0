// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature::monitor::rviz {

/// A straight line from one point to another [m].
struct Segment {
  Eigen::Vector3d from, to;
};

/// A part of the robot's picture, in a frame that it does not move against (a prismatic joint's
/// link only grows).
struct RobotPart {
  enum class Kind { link, revolute_joint, prismatic_joint };
  int id = 0;  // stable: 4 * joint, + 0 along d, + 1 along a, + 2 the body, + 3 to its placement
  Kind kind = Kind::link;
  int frame = -1;   // a joint's frame; -1: base
  Segment segment;  // a link's ends; a joint's axis, unit length, round its middle
};

/// What the Denavit-Hartenberg rows say of the robot's looks: for every joint its body and the two
/// lines along d and a that lead to the next one, and a straight one to where a placement puts its
/// row. Lines of no length are left out, except the one that a prismatic joint moves.
std::vector<RobotPart> robot_shape(const RobotModel& model, const JointVector& q);

/// How thick the robot is drawn [m]: a share of its stretched length, from its rows and limits.
double link_radius(const RobotModel& model);
/// The body of a joint, when its links have this radius: 4 times that long, and 1.5 times as thick.
Segment joint_body(const RobotPart& part, double link_radius);

}  // namespace armature::monitor::rviz
