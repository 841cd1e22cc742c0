// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/geometry.hpp"

namespace armature {

Eigen::Isometry3d to_eigen(const msg::Pose& pose) {
  return Eigen::Translation3d{to_eigen(pose.position_())} * to_eigen(pose.orientation_());
}

Eigen::Isometry3d to_eigen(const msg::Transform& transform) {
  return Eigen::Translation3d{to_eigen(transform.translation_())} * to_eigen(transform.rotation_());
}

void assign(msg::Pose& to, const Eigen::Isometry3d& pose) {
  assign(to.position_(), Eigen::Vector3d{pose.translation()});
  assign(to.orientation_(), Eigen::Quaterniond{pose.linear()});
}

void assign(msg::Transform& to, const Eigen::Isometry3d& transform) {
  assign(to.translation_(), Eigen::Vector3d{transform.translation()});
  assign(to.rotation_(), Eigen::Quaterniond{transform.linear()});
}

}  // namespace armature
