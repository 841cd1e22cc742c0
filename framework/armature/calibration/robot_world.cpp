// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/robot_world.hpp"

#include "armature/calibration/symmetric.hpp"

namespace armature {
namespace {

/// The rotation nearest to a matrix that is nearly a multiple of one, perhaps a negative one.
Eigen::Matrix3d rotation_along(const SmallVector& columns) {
  const SingularValues svd{Eigen::Map<const Eigen::Matrix3d>{columns.data()}};
  const Eigen::Matrix3d nearest = svd.left.lazyProduct(svd.right.transpose());
  return nearest.determinant() < 0 ? -nearest : nearest;
}

/// R_A R_X = R_Z R_B is (R_B (x) R_A) vec R_X = vec R_Z.
SmallMatrix sum_of_products(std::span<const HandEyePose> poses) {
  SmallMatrix sum = SmallMatrix::Zero(9, 9);
  for (const HandEyePose& pose : poses) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        sum.block<3, 3>(3 * row, 3 * column) +=
            pose.tracker_T_body.linear()(row, column) * pose.base_T_flange.linear();
      }
    }
  }
  return sum / static_cast<double>(poses.size());
}

/// R_A t_X - t_Z = R_Z t_B - t_A, least squares over all poses.
void solve_translations(std::span<const HandEyePose> poses, RobotWorld& found) {
  SmallMatrix normal = SmallMatrix::Zero(6, 6);
  SmallVector right = SmallVector::Zero(6);
  for (const HandEyePose& pose : poses) {
    SmallMatrix row(3, 6);
    row << pose.base_T_flange.linear(), -Eigen::Matrix3d::Identity();
    normal += row.transpose().lazyProduct(row);
    right += row.transpose().lazyProduct(found.base_T_tracker.linear() *
                                             pose.tracker_T_body.translation() -
                                         pose.base_T_flange.translation());
  }
  const SmallMatrix both = solve_symmetric(normal, right);
  found.flange_T_body.translation() = both.topRows<3>();
  found.base_T_tracker.translation() = both.bottomRows<3>();
}

}  // namespace

RobotWorld solve_robot_world(std::span<const HandEyePose> poses) {
  const SingularValues svd{sum_of_products(poses)};
  RobotWorld found;
  found.flange_T_body.linear() = rotation_along(svd.right.col(0));
  found.base_T_tracker.linear() = rotation_along(svd.left.col(0));
  solve_translations(poses, found);
  return found;
}

}  // namespace armature
