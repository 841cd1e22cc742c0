// SPDX-License-Identifier: Apache-2.0
// Four doubles at once. Everything is unnamed: each processor's copy is its own.
#pragma once

#include <bit>
#include <cstdint>
#include <numbers>

#if defined(__SSE2__)
#include <immintrin.h>
#else
#include <cmath>
#endif

// How vectors are passed differs between processors; here they only ever are inside one file.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace armature {
namespace {

using Lanes = double __attribute__((vector_size(32)));
using Masks = std::int64_t __attribute__((vector_size(32)));

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kSignBit = INT64_MIN;

inline Lanes all(double x) { return Lanes{x, x, x, x}; }
inline bool any(const Masks& m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }
inline Lanes magnitude(const Lanes& x) {
  return std::bit_cast<Lanes>(std::bit_cast<Masks>(x) & ~kSignBit);
}
inline Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
/// `x` >= 0 with the sign of `s`.
inline Lanes with_sign(const Lanes& x, const Lanes& s) {
  return std::bit_cast<Lanes>(std::bit_cast<Masks>(x) | (std::bit_cast<Masks>(s) & kSignBit));
}

inline Lanes root(const Lanes& x) {
#if defined(__AVX__)
  return std::bit_cast<Lanes>(_mm256_sqrt_pd(std::bit_cast<__m256d>(x)));
#elif defined(__SSE2__)
  const __m128d low = _mm_sqrt_pd(_mm_set_pd(x[1], x[0]));
  const __m128d high = _mm_sqrt_pd(_mm_set_pd(x[3], x[2]));
  return Lanes{low[0], low[1], high[0], high[1]};
#else
  return Lanes{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}

/// atan2(y, x) to within 5e-16; 0 for (0, 0), and an x of -0 is an x of 0. For small/large above
/// tan(pi/8), atan(t) = pi/4 + atan((t - 1)/(t + 1)); below, atan(t)/t is the polynomial in t^2
/// that interpolates it at the 12 Chebyshev nodes of the interval (error 1.3e-18).
inline Lanes arctangent(const Lanes& y, const Lanes& x) {
  const Lanes height = magnitude(y), width = magnitude(x);
  const Lanes large = larger(height, width), small = smaller(height, width);
  const Masks steep = small > 0.41421356237309503 * large;
  const Lanes numerator = steep ? small - large : small;
  const Lanes denominator = steep ? small + large : large;
  const Lanes t = numerator / (denominator > 0 ? denominator : all(1));
  const Lanes z = t * t, z2 = z * z, z4 = z2 * z2;
  const Lanes p03 =
      (1.0 - 0.3333333333333312 * z) + (0.19999999999940893 - 0.14285714279250245 * z) * z2;
  const Lanes p47 = (0.11111110744919658 - 0.09090896809064027 * z) +
                    (0.07692045330902225 - 0.06662951813629191 * z) * z2;
  const Lanes p811 = (0.05846878297330872 - 0.05035102456601552 * z) +
                     (0.03796525745386593 - 0.017805397205419446 * z) * z2;
  const Lanes low = t * (p03 + (p47 + p811 * z4) * z4) + (steep ? all(kPi / 4) : all(0));
  const Lanes right = height > width ? kPi / 2 - low : low;
  return with_sign(x < 0 ? kPi - right : right, y);
}

/// An angle less than one and a half turns from zero, shifted by a whole turn into [-pi, pi).
inline Lanes wrapped(const Lanes& unwrapped) {
  Lanes angle = unwrapped;
  angle -= angle >= kPi ? all(2 * kPi) : all(0);
  angle += angle < -kPi ? all(2 * kPi) : all(0);
  return angle >= kPi ? all(-kPi) : angle;
}

/// Half a turn on, towards zero.
inline Lanes half_turned(const Lanes& angle) { return angle - with_sign(all(kPi), angle); }

struct LaneTriple {
  Lanes x, y, z;
};
inline LaneTriple operator+(const LaneTriple& a, const LaneTriple& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneTriple cross(const LaneTriple& a, const LaneTriple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Lanes norm(const LaneTriple& v) { return root(v.x * v.x + v.y * v.y + v.z * v.z); }

}  // namespace
}  // namespace armature
