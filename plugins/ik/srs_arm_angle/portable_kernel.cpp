// SPDX-License-Identifier: Apache-2.0
#include "branches_body.hpp"
#include "minima_body.hpp"
#include "pieces_body.hpp"
#include "table_body.hpp"

namespace armature {

const SrsKernel& portable_srs_kernel() {
  static constexpr SrsKernel kernel{arctangents, sines_and_cosines,    turn_all_to,   turn_each_to,
                                    find_pieces, find_costs_all_round, find_costs_at, find_minima};
  return kernel;
}

SrsKernels srs_kernels() {
  SrsKernels list{{&portable_srs_kernel()}, 1};
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return list;
  list.kernel[list.count++] = &avx2_srs_kernel();
#endif
  return list;
}

const SrsKernel& srs_kernel() {
  static const SrsKernels list = srs_kernels();
  return *list.kernel[list.count - 1];
}

}  // namespace armature
