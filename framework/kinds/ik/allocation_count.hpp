// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>

// Counts the calls of malloc (and so of operator new and of Eigen's own allocations) by the calling
// thread. Defines malloc: include it in one source file of a test program. A sanitizer brings its
// own malloc; nothing is counted then.

namespace armature {
inline thread_local std::size_t allocation_count = 0;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ARMATURE_COUNTS_ALLOCATIONS 1
extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: glibc's name
void* malloc(std::size_t size) {        // NOLINT: replaces glibc's
  ++armature::allocation_count;
  return __libc_malloc(size);
}
}
#endif
