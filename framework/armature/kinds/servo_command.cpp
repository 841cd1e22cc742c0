// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/servo_command.hpp"

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/stamp.hpp"

namespace armature {

ReasonText read_servo_command(const RobotModel& model, const msg::JointState& message,
                              ServoCommand& command) {
  ServoCommand read{.stamp = stamp_of(message.header_().stamp_()), .q = {}, .v = {}};
  if (const ReasonText wrong = read_joints(model, message, read.q); !wrong.empty()) {
    return ReasonText::format("position: {}", wrong.view());
  }
  if (const ReasonText wrong = read_joint_rates(model, message, read.v); !wrong.empty()) {
    return ReasonText::format("velocity: {}", wrong.view());
  }
  command = read;
  return {};
}

}  // namespace armature
