// SPDX-License-Identifier: Apache-2.0
#include "descent_body.hpp"

namespace armature::ik::numeric::descent {

const Kernel& portable_kernel() {
  static constexpr Kernel kernel{descend_any, measure_any};
  return kernel;
}

}  // namespace armature::ik::numeric::descent
