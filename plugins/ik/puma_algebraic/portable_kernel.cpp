// SPDX-License-Identifier: Apache-2.0
#include "batch_body.hpp"
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

void solve_batch_portable(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out) {
  solve_all_poses(arm, poses, out);
}

BatchSolvers batch_solvers() {
  BatchSolvers list{{solve_batch_portable}, 1};
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return list;
  list.solve[list.count++] = solve_batch_avx2;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
  if (!wide) return list;
  list.solve[list.count++] = solve_batch_avx512;
#endif
  return list;
}

}  // namespace armature
