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
#pragma GCC target("avx2,fma")
#define ARMATURE_AVX
#include "all_branches_body.hpp"
#include "events_body.hpp"
#include "kept_body.hpp"
#include "minima_body.hpp"
#include "table_body.hpp"

namespace armature {

const SrsKernel& avx2_srs_kernel() {
  static constexpr SrsKernel kernel{arctangents,          sines_and_cosines, turn_all_to,
                                    turn_each_to,         find_events,       find_kept,
                                    find_costs_all_round, find_costs_at,     find_minima_of};
  return kernel;
}

}  // namespace armature
#pragma GCC pop_options
#endif
