// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace armature::ik_contract {

/// The smallest of the singular values of `matrix`, to its last digits. Allocates.
double smallest_singular_value(const Eigen::MatrixXd& matrix);

}  // namespace armature::ik_contract
