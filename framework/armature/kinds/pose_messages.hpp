// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string_view>

#include "armature/messages/geometry.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

// A pose of a message, checked, its quaternion made a unit: what a driver leaves at 0, 0, 0, 0
// because it tells positions only would be read as no rotation at all. `whose` begins the reason:
// "the leader's quaternion has length 0, not 1". Real-time safe but for the reason.

inline Expected<Eigen::Isometry3d> pose_of(const Eigen::Vector3d& position,
                                           const Eigen::Quaterniond& rotation,
                                           std::string_view whose) {
  const auto pose = checked(ToolPose{position, rotation}, whose);
  if (!pose) return tl::unexpected{pose.error()};
  return Eigen::Isometry3d{Eigen::Translation3d{pose->position} *
                           std::get<Eigen::Quaterniond>(pose->orientation)};
}

inline Expected<Eigen::Isometry3d> pose_of(const msg::Pose& pose, std::string_view whose) {
  return pose_of(to_eigen(pose.position_()), to_eigen(pose.orientation_()), whose);
}

inline Expected<Eigen::Isometry3d> pose_of(const msg::Transform& transform,
                                           std::string_view whose) {
  return pose_of(to_eigen(transform.translation_()), to_eigen(transform.rotation_()), whose);
}

}  // namespace armature
