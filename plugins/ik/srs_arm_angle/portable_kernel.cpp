// SPDX-License-Identifier: Apache-2.0
#include "all_branches_body.hpp"
#include "events_body.hpp"
#include "kept_body.hpp"
#include "minima_body.hpp"
#include "table_body.hpp"

namespace armature {

const SrsKernel& portable_srs_kernel() {
  static constexpr SrsKernel kernel{arctangents,          sines_and_cosines, turn_all_to,
                                    turn_each_to,         find_events,       find_kept,
                                    find_costs_all_round, find_costs_at,     find_minima_of};
  return kernel;
}

SrsKernels srs_kernels() {
  SrsKernels list{{&portable_srs_kernel()}, 1};
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return list;
  list.kernel[list.count++] = &avx2_srs_kernel();
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
  if (!wide) return list;
  list.kernel[list.count++] = &avx512_srs_kernel();
#endif
  return list;
}

const SrsKernel& srs_kernel() {
  static const SrsKernels list = srs_kernels();
  return *list.kernel[list.count - 1];
}

}  // namespace armature
