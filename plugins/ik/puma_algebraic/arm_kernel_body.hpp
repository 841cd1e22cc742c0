// SPDX-License-Identifier: Apache-2.0
// Compiled once for each kind of processor (cmake/ArmatureKernels.cmake).
#pragma once

#include "batch_body.hpp"
#if !defined(ARMATURE_AVX512)
#include "four_arms_body.hpp"
#endif

namespace armature::ARMATURE_PROCESSOR {

ArmKernel arm_kernel() {
#if defined(ARMATURE_AVX512)
  ArmKernel kernel = avx2::arm_kernel();  // four arms fill no eight lanes
  kernel.solve_poses = solve_all_poses;
  return kernel;
#else
  return {solve_four_arms, roll_errors_of, solve_all_poses};
#endif
}

}  // namespace armature::ARMATURE_PROCESSOR
