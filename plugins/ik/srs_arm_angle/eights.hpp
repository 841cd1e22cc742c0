// SPDX-License-Identifier: Apache-2.0
// Eight floats at once, for what only has to find the way. Unnamed, as the lanes of the kind are:
// each processor's copy is its own.
#pragma once

#include "armature/kinds/ik/lanes.hpp"

namespace armature {
namespace {

using Eights = float __attribute__((vector_size(32)));
using EightMasks = std::int32_t __attribute__((vector_size(32)));

/// `x` in every lane, of four doubles or eight floats.
template <class Numbers>
Numbers every(double x);
template <>
[[maybe_unused]] inline Lanes every<Lanes>(double x) {
  return all(x);
}
template <>
[[maybe_unused]] inline Eights every<Eights>(double x) {
  const auto f = static_cast<float>(x);
  return Eights{f, f, f, f, f, f, f, f};
}

inline Eights eights_of(const Lanes& low, const Lanes& high) {
  using Fours = float __attribute__((vector_size(16)));
  return __builtin_shufflevector(__builtin_convertvector(low, Fours),
                                 __builtin_convertvector(high, Fours), 0, 1, 2, 3, 4, 5, 6, 7);
}
inline EightMasks eights_of(const Masks& low, const Masks& high) {
  using Fours = std::int32_t __attribute__((vector_size(16)));
  return __builtin_shufflevector(__builtin_convertvector(low, Fours),
                                 __builtin_convertvector(high, Fours), 0, 1, 2, 3, 4, 5, 6, 7);
}

/// A bit for every lane of what comes out of a comparison.
inline unsigned bits_of(const EightMasks& m) {
#if defined(ARMATURE_AVX)
  return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(m)));
#else
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= static_cast<unsigned>(m[i] & 1) << i;
  return bits;
#endif
}
inline bool any(const EightMasks& m) { return bits_of(m) != 0; }
inline Eights magnitude(const Eights& x) {
  return std::bit_cast<Eights>(std::bit_cast<EightMasks>(x) & INT32_MAX);
}
inline Eights larger(const Eights& a, const Eights& b) { return a > b ? a : b; }
inline Eights smaller(const Eights& a, const Eights& b) { return a < b ? a : b; }
inline Eights with_sign(const Eights& x, const Eights& s) {
  return std::bit_cast<Eights>(std::bit_cast<EightMasks>(x) |
                               (std::bit_cast<EightMasks>(s) & INT32_MIN));
}

/// As those of four doubles, to some 1e-7 rad; angles of a few turns.
inline Eights near_zero(const Eights& angle) {
  const Eights rounder = every<Eights>(12582912);  // 1.5 * 2^23: adding it rounds to an integer
  const Eights turns = (angle * every<Eights>(0.5 / kPi) + rounder) - rounder;
  return angle - every<Eights>(2 * kPi) * turns;
}
inline Eights half_turned(const Eights& angle) {
  return angle - with_sign(every<Eights>(kPi), angle);
}
/// atan2(y, x) of a sine and a cosine to 4e-7: reduced as `arctangent` of four doubles, then the
/// polynomial of S. Moshier's Cephes library, atanf.
inline Eights arctangent(const Eights& y, const Eights& x) {
  const Eights height = magnitude(y), width = magnitude(x);
  const Eights large = larger(height, width), small = smaller(height, width);
  const EightMasks steep = small > 0.41421356F * large;
  const Eights t = (steep ? small - large : small) / (steep ? small + large : large);
  const Eights z = t * t;
  const Eights p =
      ((8.05374449538e-2F * z - 1.38776856032e-1F) * z + 1.99777106478e-1F) * z - 3.33329491539e-1F;
  const Eights low = (t + t * z * p) + (steep ? every<Eights>(kPi / 4) : every<Eights>(0));
  const Eights right = height > width ? every<Eights>(kPi / 2) - low : low;
  return with_sign(x < 0 ? every<Eights>(kPi) - right : right, y);
}

}  // namespace
}  // namespace armature
