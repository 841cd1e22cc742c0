// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// Reads the list under `joints:` of a robot file; every problem goes to `problems`.
std::vector<Joint> read_joints(const config::Node& list, config::Problems& problems);

/// Reads the list under `joints:` of a robot file that has its joints from a URDF file: limits in
/// place of those that are there. A new speed without an acceleration brings the usual one.
void read_other_limits(const config::Node& list, std::vector<Joint>& joints,
                       config::Problems& problems);

/// Notes a joint at `at` whose name is that of the robot's foot.
void check_joint_name(const std::string& name, const config::Origin& at,
                      config::Problems& problems);

/// The acceleration of a joint for which none is stated, in [rad/s2] or [m/s2]: the top speed in
/// 0.25 s.
double usual_acceleration(double max_velocity);

}  // namespace armature
