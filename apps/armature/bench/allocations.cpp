// SPDX-License-Identifier: Apache-2.0
#include "bench/allocations.hpp"

#include "armature/values/allocation_count.hpp"

namespace armature {

AllocationCounter allocation_counter() {
#ifdef ARMATURE_COUNTS_ALLOCATIONS
  return [] { return allocation_count; };
#else
  return nullptr;
#endif
}

}  // namespace armature
