// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

// Topics show all joints, coupled ones included; RobotModel::contract and contract_rates read them.

/// The independent joints of a list of all of them, home for an empty one. `what` begins the reason
/// why it is none: "the seed: 5 joint values; dental_lamp has 6 joints".
Expected<JointVector> joints_or_home(const RobotModel& model, std::span<const double> all,
                                     std::string_view what);

/// The independent joints of a message: by its names, which may stand in any order among others, as
/// ROS drivers write them; by their order where it has no names. Or why they are none: a joint that
/// is not among the names, and what RobotModel::contract refuses. Real-time safe but for the
/// reason.
Expected<JointVector> joints_of(const RobotModel& model, const msg::JointState& message);
/// The same of its velocities.
Expected<JointVector> joint_rates_of(const RobotModel& model, const msg::JointState& message);
/// The same into `joints`, for a control thread: empty, or the reason. Real-time safe.
ReasonText read_joints(const RobotModel& model, const msg::JointState& message,
                       JointVector& joints);
ReasonText read_joint_rates(const RobotModel& model, const msg::JointState& message,
                            JointVector& rates);

/// Position and velocity of all joints from those of the independent ones; effort empty. Real-time
/// safe once the message has had the robot's size.
void write_all_joints(const RobotModel& model, const JointVector& q, const JointVector& v,
                      Time stamp, msg::JointState& message);

}  // namespace armature
