// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/robot_world.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace armature {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

/// The rotation nearest to a matrix that is nearly a multiple of one, perhaps a negative one.
Eigen::Matrix3d rotation_along(const Vector9& columns) {
  Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix3d>{columns.data()};
  if (matrix.determinant() < 0) matrix = -matrix;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretch{matrix.transpose() * matrix};
  return matrix * stretch.operatorInverseSqrt();
}

/// R_A R_X = R_Z R_B is (R_B (x) R_A) vec R_X = vec R_Z.
Matrix9 sum_of_products(std::span<const HandEyePose> poses) {
  Matrix9 sum = Matrix9::Zero();
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
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const HandEyePose& pose : poses) {
    Eigen::Matrix<double, 3, 6> row;
    row << pose.base_T_flange.linear(), -Eigen::Matrix3d::Identity();
    normal += row.transpose() * row;
    right += row.transpose() * (found.base_T_tracker.linear() * pose.tracker_T_body.translation() -
                                pose.base_T_flange.translation());
  }
  const Eigen::Matrix<double, 6, 1> both = normal.ldlt().solve(right);
  found.flange_T_body.translation() = both.head<3>();
  found.base_T_tracker.translation() = both.tail<3>();
}

}  // namespace

RobotWorld solve_robot_world(std::span<const HandEyePose> poses) {
  const Matrix9 sum = sum_of_products(poses);
  const Eigen::SelfAdjointEigenSolver<Matrix9> singular{sum.transpose() * sum};
  const Vector9 right = singular.eigenvectors().col(8);
  RobotWorld found;
  found.flange_T_body.linear() = rotation_along(right);
  found.base_T_tracker.linear() = rotation_along(sum * right);
  solve_translations(poses, found);
  return found;
}

}  // namespace armature
