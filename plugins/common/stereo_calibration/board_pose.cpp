// SPDX-License-Identifier: Apache-2.0
#include "board_pose.hpp"

#include <Eigen/SVD>
#include <cmath>

namespace armature::stereo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Moves and scales points so that their middle is 0 and their mean distance 1.
Matrix3d normalizing(const std::vector<Vector2d>& points) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& point : points) middle += point / static_cast<double>(points.size());
  double distance = 0;
  for (const Vector2d& point : points) {
    distance += (point - middle).norm() / static_cast<double>(points.size());
  }
  Matrix3d t;
  t << 1 / distance, 0, -middle.x() / distance, 0, 1 / distance, -middle.y() / distance, 0, 0, 1;
  return t;
}

}  // namespace

Matrix3d homography(const std::vector<Vector2d>& board, const std::vector<Vector2d>& pixels) {
  const Matrix3d from = normalizing(board), to = normalizing(pixels);
  Eigen::Matrix<double, 9, 9> squares = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < board.size(); ++i) {
    const Vector3d x = from * board[i].homogeneous(), y = to * pixels[i].homogeneous();
    Eigen::Matrix<double, 2, 9> rows;
    rows << x.transpose(), Vector3d::Zero().transpose(), -y.x() * x.transpose(),
        Vector3d::Zero().transpose(), x.transpose(), -y.y() * x.transpose();
    squares += rows.transpose() * rows;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd{squares, Eigen::ComputeFullV};
  const Eigen::Matrix<double, 9, 1> h = svd.matrixV().col(8);
  const Matrix3d normalized =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{h.data()};
  return to.inverse() * normalized * from;
}

std::optional<double> focal_length(const std::vector<Matrix3d>& homographies,
                                   const Vector2d& centre) {
  // With w = 1 / f^2, the images of the board's axes are square to each other and equally long:
  // (h11 h12 + h21 h22) w = -h31 h32, and the same of their squares.
  double squares = 0, products = 0;
  Matrix3d shift = Matrix3d::Identity();
  shift.topRightCorner<2, 1>() = -centre;
  for (const Matrix3d& homography : homographies) {
    Matrix3d h = shift * homography;
    h /= h.topLeftCorner<2, 2>().norm();  // of all views alike
    const double across = h.col(0).head<2>().dot(h.col(1).head<2>());
    const double along = h.col(0).head<2>().squaredNorm() - h.col(1).head<2>().squaredNorm();
    const double right = -h(2, 0) * h(2, 1), right_along = h(2, 1) * h(2, 1) - h(2, 0) * h(2, 0);
    squares += across * across + along * along;
    products += across * right + along * right_along;
  }
  if (squares == 0 || products <= 0) return std::nullopt;
  return std::sqrt(squares / products);
}

Eigen::Isometry3d pose_of_board(const Matrix3d& homography, double focal_px,
                                const Vector2d& centre) {
  Matrix3d to_rays;
  to_rays << 1 / focal_px, 0, -centre.x() / focal_px, 0, 1 / focal_px, -centre.y() / focal_px, 0, 0,
      1;
  Matrix3d h = to_rays * homography;
  h *= 2 / (h.col(0).norm() + h.col(1).norm());
  if (h(2, 2) < 0) h = -h;  // before the camera
  Matrix3d axes;
  axes << h.col(0), h.col(1), h.col(0).cross(h.col(1));
  const Eigen::JacobiSVD<Matrix3d> svd{axes, Eigen::ComputeFullU | Eigen::ComputeFullV};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  pose.translation() = h.col(2);
  return pose;
}

}  // namespace armature::stereo
