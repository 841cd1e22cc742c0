// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limits_body.hpp"
#include "minima_body.hpp"
#include "turns_body.hpp"

namespace armature::ARMATURE_PROCESSOR {

const SrsKernel& srs_kernel() {
  static constexpr SrsKernel kernel{
      arctangents, turn_two, find_limit_roots, find_limits_kept, find_costs_all_round, find_minima};
  return kernel;
}

}  // namespace armature::ARMATURE_PROCESSOR
