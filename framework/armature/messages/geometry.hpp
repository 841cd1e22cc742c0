// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "armature/messages/geometry_msgs.hpp"

namespace armature ARMATURE_EXPORT {

// Between messages and Eigen, both ways; all real-time safe. A Transform or Pose in a message with
// frame_id a and (child) frame b is a_T_b.

inline Eigen::Vector3d to_eigen(const msg::Point& p) { return {p.x_(), p.y_(), p.z_()}; }
inline Eigen::Vector3d to_eigen(const msg::Vector3& v) { return {v.x_(), v.y_(), v.z_()}; }

/// As it stands in the message: not normalised.
inline Eigen::Quaterniond to_eigen(const msg::Quaternion& q) {
  return {q.w_(), q.x_(), q.y_(), q.z_()};
}

// As they stand in the message: kinds/pose_messages.hpp checks them. A quaternion of zeros is read
// as no rotation.
Eigen::Isometry3d to_eigen(const msg::Pose& pose);
Eigen::Isometry3d to_eigen(const msg::Transform& transform);

inline void assign(msg::Point& to, const Eigen::Vector3d& p) {
  to.x_(p.x());
  to.y_(p.y());
  to.z_(p.z());
}

inline void assign(msg::Vector3& to, const Eigen::Vector3d& v) {
  to.x_(v.x());
  to.y_(v.y());
  to.z_(v.z());
}

inline void assign(msg::Quaternion& to, const Eigen::Quaterniond& q) {
  to.x_(q.x());
  to.y_(q.y());
  to.z_(q.z());
  to.w_(q.w());
}

/// A 3 x 3 matrix, row by row.
inline Eigen::Matrix3d to_eigen(const std::array<double, 9>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{rows.data()};
}
inline void assign(std::array<double, 9>& rows, const Eigen::Matrix3d& matrix) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{rows.data()} = matrix;
}

void assign(msg::Pose& to, const Eigen::Isometry3d& pose);
void assign(msg::Transform& to, const Eigen::Isometry3d& transform);

}  // namespace armature
