// SPDX-License-Identifier: Apache-2.0
#include "branches_body.hpp"
#include "minima_body.hpp"
#include "pieces_body.hpp"

namespace armature {

const SrsKernel& portable_srs_kernel() {
  static constexpr SrsKernel kernel{arctangents,  sines_and_cosines,    turn_all_to,
                                    turn_each_to, find_pieces,          find_costs_all_round,
                                    find_costs_at, find_minima};
  return kernel;
}

const SrsKernel& srs_kernel() {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return avx2_srs_kernel();
#endif
  return portable_srs_kernel();
}

}  // namespace armature
