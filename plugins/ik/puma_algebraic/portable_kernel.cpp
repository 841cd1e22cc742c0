// SPDX-License-Identifier: Apache-2.0
#include "four_arms_body.hpp"

namespace armature {

const ArmKernel& portable_arm_kernel() {
  static constexpr ArmKernel kernel{solve_four_arms, roll_errors_of};
  return kernel;
}

const ArmKernel& arm_kernel() {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return avx2_arm_kernel();
#endif
  return portable_arm_kernel();
}

}  // namespace armature
