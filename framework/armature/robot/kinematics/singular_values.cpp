// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/singular_values.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace armature {
namespace {

/// Square, which spares Eigen's rotations a preconditioner, and this file seconds of its
/// compilation.
SmallMatrix filled_up(const SmallMatrix& matrix) {
  const auto n = std::max(matrix.rows(), matrix.cols());
  SmallMatrix square = SmallMatrix::Zero(n, n);
  square.topLeftCorner(matrix.rows(), matrix.cols()) = matrix;
  return square;
}

/// The rotation of two columns with the squared lengths a and b and the product c that makes them
/// square to each other.
Eigen::JacobiRotation<double> turn_square(double a, double b, double c) {
  const double zeta = (b - a) / (2 * c);
  const double tangent = std::copysign(1 / (std::abs(zeta) + std::sqrt(1 + zeta * zeta)), zeta);
  const double cosine = 1 / std::sqrt(1 + tangent * tangent);
  return {cosine, cosine * tangent};
}

using Rotations = Eigen::JacobiSVD<SmallMatrix, Eigen::NoQRPreconditioner>;

}  // namespace

SingularValues::SingularValues(const SmallMatrix& matrix) {
  const Rotations rotations{filled_up(matrix), Eigen::ComputeFullU | Eigen::ComputeFullV};
  values = rotations.singularValues();
  left = rotations.matrixU();
  right = rotations.matrixV();
}

/// One-sided Jacobi rotations (Hestenes 1958) make the columns of the matrix, or of its transpose,
/// square to each other; their lengths are then its singular values, which need no vectors here.
double smallest_singular_value(const SmallMatrix& matrix) {
  constexpr double kSquare = 1e-15;
  constexpr int kMaxSweeps = 40;
  SmallMatrix turned = matrix;
  if (matrix.cols() > matrix.rows()) turned = matrix.transpose();
  bool square = false;
  for (int sweep = 0; sweep < kMaxSweeps && !square; ++sweep) {
    square = true;
    for (Eigen::Index i = 0; i + 1 < turned.cols(); ++i) {
      for (Eigen::Index j = i + 1; j < turned.cols(); ++j) {
        const double a = turned.col(i).squaredNorm(), b = turned.col(j).squaredNorm();
        const double c = turned.col(i).dot(turned.col(j));
        if (std::abs(c) <= kSquare * std::sqrt(a) * std::sqrt(b)) continue;
        square = false;
        turned.applyOnTheRight(i, j, turn_square(a, b, c));
      }
    }
  }
  return turned.colwise().norm().minCoeff();
}

SmallVector shortest_solution(const SmallMatrix& matrix, const SmallVector& right) {
  const SingularValues svd{matrix};
  const double none = svd.values[0] * static_cast<double>(svd.values.size()) *
                      std::numeric_limits<double>::epsilon();
  SmallVector x = SmallVector::Zero(matrix.cols());
  for (Eigen::Index i = 0; i < svd.values.size() && svd.values[i] > none; ++i) {
    const double along = svd.left.col(i).head(matrix.rows()).dot(right);
    x += along / svd.values[i] * svd.right.col(i).head(matrix.cols());
  }
  return x;
}

}  // namespace armature
