// SPDX-License-Identifier: Apache-2.0
#include "pose_average.hpp"

#include <Eigen/SVD>

namespace armature::task::implant {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Eigen::Isometry3d PoseAverage::mean() const {
  Matrix3d rotations = Matrix3d::Zero();
  Vector3d positions = Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : poses_) {
    rotations += pose.linear();
    positions += pose.translation();
  }
  const Eigen::JacobiSVD<Matrix3d> svd{rotations, Eigen::ComputeFullU | Eigen::ComputeFullV};
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = svd.matrixU() * svd.matrixV().transpose();
  mean.translation() = positions / count();
  return mean;
}

PointError PoseAverage::error_at(const Vector3d& point) const {
  Vector3d middle = Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : poses_) middle += pose * point / count();
  Matrix3d scatter = Matrix3d::Zero();
  for (const Eigen::Isometry3d& pose : poses_) {
    const Vector3d off = pose * point - middle;
    scatter += off * off.transpose();
  }
  return point_error(scatter / (count() - 1) / count());
}

}  // namespace armature::task::implant
