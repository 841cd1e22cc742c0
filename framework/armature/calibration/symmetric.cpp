// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/symmetric.hpp"

#include <Eigen/Cholesky>

namespace armature {

SmallMatrix solve_symmetric(const SmallMatrix& matrix, const SmallMatrix& right) {
  return matrix.ldlt().solve(right);
}

}  // namespace armature
