// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>

// Counts how often the calling thread asks for memory: malloc (and so operator new and Eigen's own
// allocations) and its like. Defines these functions: include it in one source file of a program.
// A sanitizer brings its own; nothing is counted then.

namespace armature ARMATURE_EXPORT {
inline thread_local std::size_t allocation_count = 0;
/// Called on every one, where it is set: for who counts otherwise than by thread.
inline void (*on_allocation)() = nullptr;

inline void count_allocation() {
  ++allocation_count;
  if (on_allocation) on_allocation();
}

/// How often `work` asks for memory.
template <class Work>
std::size_t allocations_of(Work work) {
  const std::size_t before = allocation_count;
  work();
  return allocation_count - before;
}
}  // namespace armature

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ARMATURE_COUNTS_ALLOCATIONS 1
// NOLINTBEGIN: the names are glibc's
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  armature::count_allocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  armature::count_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  armature::count_allocation();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  armature::count_allocation();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}
// NOLINTEND
#endif
