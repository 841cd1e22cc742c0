// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/remote_centre.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// A place of the tip, in the base frame [m], and joints within limits that bring it there.
struct ReachedPoint {
  Eigen::Vector3d position;
  JointVector q;
};

struct Workspace {
  std::vector<ReachedPoint> points;
  std::size_t tried = 0;  // places, of which the points are those that can be reached
};

/// Where the tip comes to at so many random joint positions within the limits, evenly over the
/// joints (not over space). A joint that turns without an end takes one turn; one that slides needs
/// limits.
Workspace free_workspace(const RobotModel& model, std::size_t samples, std::uint64_t seed);

/// Where the tip comes to with the shaft in an incision: of so many places, evenly in the ball
/// about it that is as large as the shaft is long and without its innermost `min_depth` [m], those
/// for which `solver` finds joints within limits, however the shaft is rolled. The share of places
/// that are reached is the share of the ball's volume.
Workspace workspace_about(const RemoteCentre& centre, double min_depth, const RobotModel& model,
                          const IkSolver& solver, std::size_t samples, std::uint64_t seed);

/// [m3] Of that ball.
double ball_volume(const RemoteCentre& centre, double min_depth);

}  // namespace armature
