// SPDX-License-Identifier: Apache-2.0
// armature_add_kernel compiles this once for each kind of processor.
#include "arm_kernel.hpp"

#include "branches_body.hpp"
#include "limits_body.hpp"
#include "minima_body.hpp"

namespace armature::ik::srs_arm_angle {

const Kernel& ARMATURE_FOR_PROCESSOR(kernel)() {
  static constexpr Kernel kernel{arctangents,  sines_and_cosines, solve_all,       solve_each,
                                 limit_angles, keep_limits,       costs_all_round, costs,
                                 minima};
  return kernel;
}

}  // namespace armature::ik::srs_arm_angle
