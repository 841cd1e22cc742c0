// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/singular_value.hpp"

#include <Eigen/SVD>

namespace armature::ik_contract {

double smallest_singular_value(const Eigen::MatrixXd& matrix) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>{matrix}.singularValues().minCoeff();
}

}  // namespace armature::ik_contract
