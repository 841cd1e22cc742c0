// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace armature {

/// A function that says how often its thread has called malloc and its like, in this program and
/// every library that it loads; nullptr where a sanitizer has a malloc of its own.
using AllocationCounter = std::size_t (*)();
AllocationCounter allocation_counter();

}  // namespace armature
