// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/singular_values.hpp"

#include <Eigen/SVD>
#include <algorithm>
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

using Rotations = Eigen::JacobiSVD<SmallMatrix, Eigen::NoQRPreconditioner>;

}  // namespace

SingularValues::SingularValues(const SmallMatrix& matrix) {
  const Rotations rotations{filled_up(matrix), Eigen::ComputeFullU | Eigen::ComputeFullV};
  values = rotations.singularValues();
  left = rotations.matrixU();
  right = rotations.matrixV();
}

double smallest_singular_value(const SmallMatrix& matrix) {
  return Rotations{filled_up(matrix)}.singularValues()[std::min(matrix.rows(), matrix.cols()) - 1];
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
