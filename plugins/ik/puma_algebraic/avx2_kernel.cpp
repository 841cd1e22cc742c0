// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#define ARMATURE_AVX
#include "batch_body.hpp"
#include "four_arms_body.hpp"

namespace armature {

const ArmKernel& avx2_kernel() {
  static constexpr ArmKernel kernel{solve_four_arms, roll_errors_of, solve_all_poses};
  return kernel;
}

}  // namespace armature
#pragma GCC pop_options
#endif
