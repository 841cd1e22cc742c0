// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/joint_messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "armature/messages/header.hpp"

namespace armature {

Expected<JointVector> joints_or_home(const RobotModel& model, std::span<const double> all,
                                     std::string_view what) {
  if (all.empty()) return resting_position(model);
  auto joints = model.to_independent(all);
  if (!joints) return refuse(std::string{what} + ": " + joints.error().text);
  return joints;
}

namespace {

/// Whether the names are those of the robot's joints in their order; so they mostly are.
bool in_order(const RobotModel& model, const std::vector<std::string>& names) {
  return std::ranges::equal(names, model.joints(), {}, {}, &Joint::name);
}

/// A value of every joint, in the robot's order: empty, or why not.
ReasonText by_name(const RobotModel& model, const std::vector<std::string>& names,
                   const std::vector<double>& values, JointVector& all) {
  if (values.size() != names.size()) {
    return ReasonText::format("{} values for {} names", values.size(), names.size());
  }
  const auto& joints = model.joints();
  all.resize(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto found = std::ranges::find(names, joints[j].name);
    if (found == names.end()) {
      return ReasonText::format("joint '{}' of {} is not among the names {}", joints[j].name,
                                model.name(), fmt::join(names, ", "));
    }
    all[static_cast<Eigen::Index>(j)] = values[static_cast<std::size_t>(found - names.begin())];
  }
  return {};
}

Expected<JointVector> expected(const ReasonText& wrong, const JointVector& joints) {
  if (wrong.empty()) return joints;
  return refuse(std::string{wrong.view()});
}

}  // namespace

ReasonText read_joints(const RobotModel& model, const msg::JointState& message,
                       JointVector& joints) {
  if (message.name_().empty() || in_order(model, message.name_())) {
    return model.to_independent(message.position_(), joints);
  }
  JointVector all;
  const ReasonText wrong = by_name(model, message.name_(), message.position_(), all);
  if (!wrong.empty()) return wrong;
  return model.to_independent({all.data(), static_cast<std::size_t>(all.size())}, joints);
}

ReasonText read_joint_rates(const RobotModel& model, const msg::JointState& message,
                            JointVector& rates) {
  if (message.name_().empty() || in_order(model, message.name_())) {
    return model.contract_rates(message.velocity_(), rates);
  }
  JointVector all;
  const ReasonText wrong = by_name(model, message.name_(), message.velocity_(), all);
  if (!wrong.empty()) return wrong;
  return model.contract_rates({all.data(), static_cast<std::size_t>(all.size())}, rates);
}

Expected<JointVector> joints_of(const RobotModel& model, const msg::JointState& message) {
  JointVector joints;
  const ReasonText wrong = read_joints(model, message, joints);
  return expected(wrong, joints);
}

Expected<JointVector> joint_rates_of(const RobotModel& model, const msg::JointState& message) {
  JointVector rates;
  const ReasonText wrong = read_joint_rates(model, message, rates);
  return expected(wrong, rates);
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
