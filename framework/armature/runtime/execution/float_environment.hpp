// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfenv>
#include <cstdint>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace armature ARMATURE_EXPORT {

/// Keeps, while it exists, how the calling thread rounds, what of its floating-point numbers traps,
/// and whether the smallest of them count as 0; without SSE2 only how it rounds. A component that
/// changes it changes what the next ones on its thread compute, and a library that is linked with
/// -ffast-math what all threads do that begin later. Real-time safe.
class FloatEnvironment {
 public:
  FloatEnvironment() : kept_{now()} {}
  ~FloatEnvironment() { restore(); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;
  /// True when it was another one, as it is no more.
  bool restore() const {
    if (now() == kept_) return false;
    std::fesetenv(FE_DFL_ENV);
#ifdef __SSE2__
    _mm_setcsr(kept_);
#else
    std::fesetround(static_cast<int>(kept_));
#endif
    return true;
  }

 private:
  static std::uint32_t now() {
#ifdef __SSE2__
    constexpr std::uint32_t kFlags = 0x3f;  // what has happened, which is nobody's setting
    return _mm_getcsr() & ~kFlags;
#else
    return static_cast<std::uint32_t>(std::fegetround());
#endif
  }

  std::uint32_t kept_;
};

}  // namespace armature
