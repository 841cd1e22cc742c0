// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace armature {

// Symmetric matrices of any size, for what a calibration solves: these are compiled once.

/// x with matrix * x = right; `matrix` is positive definite, or nearly.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

struct Spectrum {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // one a column
};
Spectrum spectrum_of(const Eigen::MatrixXd& matrix);

}  // namespace armature
