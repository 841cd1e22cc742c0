// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

// What stands in a message about where something is, checked: "the leader is stated in frame
// 'camera', not in 'base'", "the leader's quaternion has length 0, not 1". Real-time safe but for
// the reason.

inline Expected<Eigen::Isometry3d> pose_in_base(const msg::Header& header,
                                                const Eigen::Vector3d& position,
                                                const Eigen::Quaterniond& rotation,
                                                std::string_view what) {
  if (auto wrong = not_in_base(header, what)) return refuse(*wrong);
  const auto pose = checked(ToolPose{position, rotation}, std::string{what} + "'s");
  if (!pose) return tl::unexpected{pose.error()};
  return Eigen::Isometry3d{Eigen::Translation3d{pose->position} *
                           std::get<Eigen::Quaterniond>(pose->orientation)};
}

inline Expected<Eigen::Isometry3d> pose_in_base(const msg::PoseStamped& message,
                                                std::string_view what) {
  return pose_in_base(message.header_(), to_eigen(message.pose_().position_()),
                      to_eigen(message.pose_().orientation_()), what);
}

inline Expected<Eigen::Isometry3d> pose_in_base(const msg::TransformStamped& message,
                                                std::string_view what) {
  return pose_in_base(message.header_(), to_eigen(message.transform_().translation_()),
                      to_eigen(message.transform_().rotation_()), what);
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
