// SPDX-License-Identifier: Apache-2.0

#include "descent.hpp"

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#define ARMATURE_AVX
#include "descent_body.hpp"

namespace armature::ik::numeric::descent {

const Kernel& avx2_kernel() {
  static constexpr Kernel kernel{descend_any, measure_any};
  return kernel;
}

}  // namespace armature::ik::numeric::descent
#pragma GCC pop_options
#endif
