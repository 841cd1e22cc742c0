// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature::bench {

enum class Shape { point_to_point, curve };
std::string_view to_string(Shape shape);

/// From rest to rest, straight in joint space or on a curve through 20 waypoints.
struct Motion {
  TrajectoryRequest request;
  double min_s = 0;  // no motion to the end that keeps the limits is shorter
};

/// The same `count` motions for the same robot and seed: ends uniform within the robot's limits.
std::vector<Motion> motions(const RobotModel& model, Shape shape, int count, std::uint64_t seed);

/// The least time for a way from rest to rest within a velocity and an acceleration, whatever the
/// jerk: speed up, coast, slow down (Bobrow, Dubowsky and Gibson 1985 for a straight way).
double min_time(double way, double max_velocity, double max_acceleration);

}  // namespace armature::bench
