// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/kinematics/singular_values.hpp"

namespace armature {

/// x with matrix * x = right; `matrix` is positive definite, or nearly: what it
/// hardly determines comes out large. Compiled once for all that a calibration solves.
SmallMatrix solve_symmetric(const SmallMatrix& matrix, const SmallMatrix& right);

}  // namespace armature
