// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "armature/kinds/pose_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

// What stands in a message about where something is, checked: "the leader is stated in frame
// 'camera', not in 'base'", "the leader's quaternion has length 0, not 1". Real-time safe but for
// the reason.

inline Expected<Eigen::Isometry3d> pose_in_base(const msg::PoseStamped& message,
                                                std::string_view what) {
  if (auto wrong = not_in_base(message.header_(), what)) return refuse(*wrong);
  return pose_of(message.pose_(), std::string{what} + "'s");
}

inline Expected<Eigen::Isometry3d> pose_in_base(const msg::TransformStamped& message,
                                                std::string_view what) {
  if (auto wrong = not_in_base(message.header_(), what)) return refuse(*wrong);
  return pose_of(message.transform_(), std::string{what} + "'s");
}

/// Empty, or why a point that shall be in the base frame is not. Real-time safe.
inline ReasonText defect_of_point(const msg::Header& header, const Eigen::Vector3d& point,
                                  std::string_view what) {
  if (header.frame_id_() != kBaseFrame) {
    return ReasonText::format("{} is stated in frame '{}', not in '{}'", what, header.frame_id_(),
                              kBaseFrame);
  }
  if (point.allFinite()) return {};
  return ReasonText::format(
      "{}'s point ({}, {}, {}) is not finite; tell it again with three numbers "
      "in metres",
      what, point.x(), point.y(), point.z());
}

}  // namespace armature
