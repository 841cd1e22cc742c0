// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Where an arm shall be: independent joints [rad or m] and their rates, for the instant `stamp`.
struct ServoCommand {
  Time stamp;
  JointVector q, v;
};

/// Whether `command` comes after one that is newer, as over a network that does not keep their
/// order: the arm must not go back to it.
inline bool is_overtaken(const ServoCommand& command, const std::optional<ServoCommand>& newest) {
  return newest && command.stamp < newest->stamp;
}

/// Reads `message` into `command`, or tells why it is none ("velocity: j1 = inf is not a number")
/// and leaves `command` as it was. Real-time safe.
ReasonText read_servo_command(const RobotModel& model, const msg::JointState& message,
                              ServoCommand& command);

}  // namespace armature
