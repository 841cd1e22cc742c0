// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature ARMATURE_EXPORT {

/// Built with a sanitizer that has an allocator of its own: memory that was freed is held back and
/// what a process holds cannot be compared.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace armature
