// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature {

// Topics show all joints, coupled ones included; RobotModel::contract and contract_rates read them.

/// The independent joints of a list of all of them, home for an empty one. `what` begins the reason
/// why it is none: "the seed: 5 joint values; dental_lamp has 6 joints".
Expected<JointVector> joints_or_home(const RobotModel& model, std::span<const double> all,
                                     std::string_view what);

/// Position and velocity of all joints from those of the independent ones; effort empty. Real-time
/// safe once the message has had the robot's size.
void write_all_joints(const RobotModel& model, const JointVector& q, const JointVector& v,
                      Time stamp, msg::JointState& message);

}  // namespace armature
