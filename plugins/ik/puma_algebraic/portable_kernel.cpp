// SPDX-License-Identifier: Apache-2.0
#include "batch_body.hpp"
#include "four_arms_body.hpp"

namespace armature {

ArmKernels arm_kernels() {
  ArmKernels list{{{solve_four_arms, roll_errors_of, solve_all_poses}}, 1};
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return list;
  list.kernel[list.count++] = avx2_kernel();
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
  if (!wide) return list;
  list.kernel[list.count] = avx2_kernel();  // four arms fill no eight lanes
  list.kernel[list.count++].solve_poses = solve_poses_avx512;
#endif
  return list;
}

}  // namespace armature
