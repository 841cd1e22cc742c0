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
#pragma GCC target("avx512f,avx512dq,avx512vl,avx2,fma")
#define ARMATURE_AVX
#define ARMATURE_AVX512
#include "batch_body.hpp"

namespace armature {

void solve_poses_avx512(const ArmNumbers& arm, const PoseBatch& poses, const PoseAnswers& out) {
  solve_all_poses(arm, poses, out);
}

}  // namespace armature
#pragma GCC pop_options
#endif
