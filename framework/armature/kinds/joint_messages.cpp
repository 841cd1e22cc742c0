// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/joint_messages.hpp"

#include <cstddef>
#include <string>

#include "armature/messages/header.hpp"

namespace armature {

Expected<JointVector> joints_or_home(const RobotModel& model, std::span<const double> all,
                                     std::string_view what) {
  if (all.empty()) return resting_position(model);
  auto joints = model.contract(all);
  if (!joints) return refuse(std::string{what} + ": " + joints.error().text);
  return joints;
}

void write_all_joints(const RobotModel& model, const JointVector& q, const JointVector& v,
                      Time stamp, msg::JointState& message) {
  write_header(message.header_(), stamp, kBaseFrame);
  const std::size_t count = model.joints().size();
  message.name_().resize(count);
  message.position_().resize(count);
  message.velocity_().resize(count);
  message.effort_().clear();
  for (std::size_t j = 0; j < count; ++j) {
    const ChainLink& link = model.chain()[j];
    message.name_()[j] = model.joints()[j].name;
    message.position_()[j] = link.ratio * q[link.independent] + link.offset;
    message.velocity_()[j] = link.ratio * v[link.independent];
  }
}

}  // namespace armature
