// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/robot_world.hpp"

#include "armature/calibration/symmetric.hpp"

namespace armature {
namespace {

/// The rotation nearest to a matrix that is nearly a multiple of one, perhaps a negative one.
Eigen::Matrix3d rotation_along(const Eigen::VectorXd& columns) {
  Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix3d>{columns.data()};
  if (matrix.determinant() < 0) matrix = -matrix;
  const Spectrum stretch = spectrum_of(matrix.transpose() * matrix);
  const Eigen::Matrix3d along = stretch.vectors;
  const Eigen::Vector3d shrink = stretch.values.cwiseSqrt().cwiseInverse();
  return matrix * along * shrink.asDiagonal() * along.transpose();
}

/// R_A R_X = R_Z R_B is (R_B (x) R_A) vec R_X = vec R_Z.
Eigen::MatrixXd sum_of_products(std::span<const HandEyePose> poses) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(9, 9);
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
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6, 6);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6);
  for (const HandEyePose& pose : poses) {
    Eigen::MatrixXd row(3, 6);
    row << pose.base_T_flange.linear(), -Eigen::Matrix3d::Identity();
    normal += row.transpose() * row;
    right += row.transpose() * (found.base_T_tracker.linear() * pose.tracker_T_body.translation() -
                                pose.base_T_flange.translation());
  }
  const Eigen::VectorXd both = solve_symmetric(normal, right);
  found.flange_T_body.translation() = both.head<3>();
  found.base_T_tracker.translation() = both.tail<3>();
}

}  // namespace

RobotWorld solve_robot_world(std::span<const HandEyePose> poses) {
  const Eigen::MatrixXd sum = sum_of_products(poses);
  const Eigen::VectorXd right = spectrum_of(sum.transpose() * sum).vectors.col(8);
  RobotWorld found;
  found.flange_T_body.linear() = rotation_along(right);
  found.base_T_tracker.linear() = rotation_along(sum * right);
  solve_translations(poses, found);
  return found;
}

}  // namespace armature
