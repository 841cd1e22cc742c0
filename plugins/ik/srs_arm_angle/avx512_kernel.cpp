// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>

#include "arm_kernel.hpp"

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl,avx2,fma")
#define ARMATURE_AVX
#define ARMATURE_AVX512
#include "branches_body.hpp"
#include "kept_body.hpp"
#include "minima_body.hpp"
#include "table_body.hpp"

namespace armature {

const SrsKernel& avx512_srs_kernel() {
  static const SrsKernel kernel = [] {
    SrsKernel wide = avx2_srs_kernel();
    wide.turn_each = turn_each_to;
    wide.limits_kept = find_kept;
    wide.cost_all_round = find_costs_all_round;
    wide.cost_at = find_costs_at;
    wide.find_minima = find_minima_of;
    return wide;
  }();
  return kernel;
}

}  // namespace armature
#pragma GCC pop_options
#endif
