// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "armature/kinds/target/target.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"

namespace armature ARMATURE_EXPORT {

/// The estimate of a message with its normal made a unit, or why it is none: the message's own
/// reason, another frame, a number that is not finite, a normal without a direction.
inline Expected<TargetEstimate> estimate_of(const msg::Target& message) {
  if (!message.valid_()) return refuse(message.reason_());
  if (const auto wrong = not_in_base(message.header_(), "the target")) return refuse(*wrong);
  TargetEstimate estimate{.stamp = stamp_of(message.header_().stamp_()),
                          .position = to_eigen(message.position_()),
                          .normal = to_eigen(message.normal_()),
                          .velocity = to_eigen(message.velocity_()),
                          .normal_rate = to_eigen(message.normal_rate_()),
                          .measurements = static_cast<int>(message.measurements_())};
  if (!estimate.position.allFinite() || !estimate.normal.allFinite() ||
      !estimate.velocity.allFinite() || !estimate.normal_rate.allFinite()) {
    return refuse("the target is not finite");
  }
  const double length = estimate.normal.norm();
  if (!(length > 1e-9)) return refuse("the target's normal has no direction");
  estimate.normal /= length;
  return estimate;
}

/// A valid message of the estimate; every field is written.
inline void write_estimate(const TargetEstimate& estimate, msg::Target& message) {
  write_header(message.header_(), estimate.stamp, kBaseFrame);
  message.valid_(true);
  message.reason_().clear();
  assign(message.position_(), estimate.position);
  assign(message.normal_(), estimate.normal);
  assign(message.velocity_(), estimate.velocity);
  assign(message.normal_rate_(), estimate.normal_rate);
  message.measurements_(static_cast<std::uint32_t>(estimate.measurements));
}

/// A message that says why there is no estimate at `stamp`.
inline void write_no_estimate(Time stamp, const Reason& reason, msg::Target& message) {
  write_estimate(
      {.stamp = stamp, .position = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::Zero()},
      message);
  message.valid_(false);
  message.reason_() = reason.text;
}

}  // namespace armature
