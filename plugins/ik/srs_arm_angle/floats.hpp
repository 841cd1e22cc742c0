// SPDX-License-Identifier: Apache-2.0
// Twice as many floats as lanes at once, for what only has to find the way. Unnamed, as the lanes
// of the kind are: each processor's copy is its own.
#pragma once

#include <cmath>
#include <type_traits>

#include "armature/kinds/ik/lanes.hpp"

namespace armature {
namespace {

constexpr int kFloats = 2 * kLanes;
using Floats = float __attribute__((vector_size(4 * kFloats)));
using FloatMasks = std::int32_t __attribute__((vector_size(4 * kFloats)));

struct FloatSinCos {
  Floats sin, cos;
};
/// What goes with lanes or floats.
template <class Numbers>
using SinCosOf = std::conditional_t<std::is_same_v<Numbers, Lanes>, LaneSinCos, FloatSinCos>;
template <class Numbers>
using MasksOf = std::conditional_t<std::is_same_v<Numbers, Lanes>, Masks, FloatMasks>;

/// `x` in every lane, of doubles or floats.
template <class Numbers>
Numbers every(double x);
template <>
[[maybe_unused]] inline Lanes every<Lanes>(double x) {
  return all(x);
}
template <>
[[maybe_unused]] inline Floats every<Floats>(double x) {
  const auto f = static_cast<float>(x);
  return f - Floats{};
}

/// Of the lower and of the upper half.
inline Floats floats_of(const Lanes& low, const Lanes& high) {
  using Half = float __attribute__((vector_size(4 * kLanes)));
  struct Halves {
    Half low, high;
  };
  return std::bit_cast<Floats>(
      Halves{__builtin_convertvector(low, Half), __builtin_convertvector(high, Half)});
}
inline FloatSinCos floats_of(const LaneSinCos& low, const LaneSinCos& high) {
  return {floats_of(low.sin, high.sin), floats_of(low.cos, high.cos)};
}

/// A bit for every lane of what comes out of a comparison.
inline unsigned bits_of(const FloatMasks& m) {
#if defined(ARMATURE_AVX512)
  return _mm512_movepi32_mask(std::bit_cast<__m512i>(m));
#elif defined(ARMATURE_AVX)
  return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(m)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kFloats; ++i) bits |= static_cast<unsigned>(m[i] & 1) << i;
  return bits;
#endif
}
inline bool any(const FloatMasks& m) { return bits_of(m) != 0; }
inline Floats magnitude(const Floats& x) {
  return std::bit_cast<Floats>(std::bit_cast<FloatMasks>(x) & INT32_MAX);
}
inline Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
inline Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
inline Floats with_sign(const Floats& x, const Floats& s) {
  return std::bit_cast<Floats>(std::bit_cast<FloatMasks>(x) |
                               (std::bit_cast<FloatMasks>(s) & INT32_MIN));
}

inline Floats root(const Floats& x) {
#if defined(ARMATURE_AVX512)
  return std::bit_cast<Floats>(_mm512_maskz_sqrt_ps(0xFFFF, std::bit_cast<__m512>(x)));
#elif defined(ARMATURE_AVX)
  return std::bit_cast<Floats>(_mm256_sqrt_ps(std::bit_cast<__m256>(x)));
#else
  Floats roots;
  for (int i = 0; i < kFloats; ++i) roots[i] = std::sqrt(x[i]);
  return roots;
#endif
}

/// As those of doubles, to some 1e-7 rad; angles of a few turns.
inline Floats near_zero(const Floats& angle) {
  const Floats rounder = every<Floats>(12582912);  // 1.5 * 2^23: adding it rounds to an integer
  const Floats turns = (angle * every<Floats>(0.5 / kPi) + rounder) - rounder;
  return angle - every<Floats>(2 * kPi) * turns;
}
inline Floats half_turned(const Floats& angle) {
  return angle - with_sign(every<Floats>(kPi), angle);
}
/// atan2(y, x) of a sine and a cosine to 4e-7: reduced as `arctangent` of doubles, then the
/// polynomial of S. Moshier's Cephes library, atanf.
inline Floats arctangent(const Floats& y, const Floats& x) {
  const Floats height = magnitude(y), width = magnitude(x);
  const Floats large = larger(height, width), small = smaller(height, width);
  const FloatMasks steep = small > 0.41421356F * large;
  const Floats t = (steep ? small - large : small) / (steep ? small + large : large);
  const Floats z = t * t;
  const Floats p =
      ((8.05374449538e-2F * z - 1.38776856032e-1F) * z + 1.99777106478e-1F) * z - 3.33329491539e-1F;
  const Floats low = (t + t * z * p) + (steep ? every<Floats>(kPi / 4) : every<Floats>(0));
  const Floats right = height > width ? every<Floats>(kPi / 2) - low : low;
  return with_sign(x < 0 ? every<Floats>(kPi) - right : right, y);
}

}  // namespace
}  // namespace armature
