// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/model/joint_vector.hpp"

namespace armature ARMATURE_EXPORT {

/// A vector and a matrix with at most kMaxJoints rows and columns, kept without allocation.
using SmallVector = JointVector;
using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;

/// matrix = left * values.asDiagonal() * right.transpose(): the one decomposition of small
/// matrices, compiled once. With n the longer of the matrix' sides: `left` and `right` are n x n (a
/// matrix that is not square is filled up with zeros), `values` descend and are zero beyond the
/// shorter side. By Jacobi rotations, which give every value to its last digits. Real-time safe.
struct SingularValues {
  SmallVector values;
  SmallMatrix left, right;

  explicit SingularValues(const SmallMatrix& matrix);
};

/// The smallest of as many as the shorter side has.
double smallest_singular_value(const SmallMatrix& matrix);

/// The shortest x with the least |matrix * x - right|. Real-time safe.
SmallVector shortest_solution(const SmallMatrix& matrix, const SmallVector& right);

}  // namespace armature
