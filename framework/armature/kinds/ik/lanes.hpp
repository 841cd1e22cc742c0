// SPDX-License-Identifier: Apache-2.0
// Four doubles at once, or eight, for solvers whose arithmetic is compiled once for each kind of
// processor. Everything is unnamed: each processor's copy is its own. Whose copy is for processors
// with AVX defines ARMATURE_AVX before this, for those with AVX-512 ARMATURE_AVX512, which makes it
// eight: the pragma that chooses a processor defines no macro.
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

namespace armature ARMATURE_EXPORT {
namespace {

#if defined(ARMATURE_AVX512)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
using Lanes = double __attribute__((vector_size(8 * kLanes)));
using Masks = std::int64_t __attribute__((vector_size(8 * kLanes)));

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kSignBit = INT64_MIN;

inline Lanes all(double x) { return x - Lanes{}; }
/// A bit for every lane of what comes out of a comparison.
inline unsigned bits_of(const Masks& m) {
#if defined(ARMATURE_AVX512)
  return _mm512_movepi64_mask(std::bit_cast<__m512i>(m));
#elif defined(ARMATURE_AVX)
  return static_cast<unsigned>(_mm256_movemask_pd(std::bit_cast<__m256d>(m)));
#else
  return static_cast<unsigned>((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
#endif
}
inline bool any(const Masks& m) { return bits_of(m) != 0; }
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
#if defined(ARMATURE_AVX512)
  return std::bit_cast<Lanes>(_mm512_maskz_sqrt_pd(0xFF, std::bit_cast<__m512d>(x)));
#elif defined(ARMATURE_AVX)
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

struct LaneSinCos {
  Lanes sin, cos;
};
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer

/// Sines and cosines of angles of at most 1e5 rad, wrong by less than 2 units in the last place:
/// reduced by quarter turns (three parts of pi/2), then the polynomials of W. J. Cody and W. Waite,
/// "Software Manual for the Elementary Functions", 1980, with the coefficients of Sun's fdlibm.
inline LaneSinCos sine_and_cosine(const Lanes& x) {
  const Lanes rounded = x * 0.63661977236758134308 + kRounder;
  const Masks quarter = std::bit_cast<Masks>(rounded);
  const Lanes k = rounded - kRounder;
  const Lanes r = ((x - k * 1.57079632673412561417) - k * 6.07710050630396597660e-11) -
                  k * 2.02226624879595063154e-21;
  const Lanes z = r * r;
  const Lanes s =
      r + r * z *
              (-1.66666666666666324348e-01 +
               z * (8.33333333332248946124e-03 +
                    z * (-1.98412698298579493134e-04 +
                         z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 +
                                                                z * 1.58969099521155010221e-10)))));
  const Lanes c =
      1 - 0.5 * z +
      z * z *
          (4.16666666666666019037e-02 +
           z * (-1.38888888888741095749e-03 +
                z * (2.48015872894767294178e-05 +
                     z * (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const Masks odd = -(quarter & 1);
  const Masks sine_sign = (quarter & 2) << 62, cosine_sign = ((quarter + 1) & 2) << 62;
  const Masks sw = std::bit_cast<Masks>(s), cw = std::bit_cast<Masks>(c);
  return {std::bit_cast<Lanes>(((cw & odd) | (sw & ~odd)) ^ sine_sign),
          std::bit_cast<Lanes>(((sw & odd) | (cw & ~odd)) ^ cosine_sign)};
}

/// An angle less than 1e5 rad from zero, shifted by whole turns to within half a turn of zero; what
/// it does at half a turn is not said.
inline Lanes near_zero(const Lanes& angle) {
  return angle - 2 * kPi * ((angle * (0.5 / kPi) + kRounder) - kRounder);
}

/// The same into [-pi, pi); an angle that is there keeps every bit.
inline Lanes wrapped(const Lanes& unwrapped) {
  Lanes angle = near_zero(unwrapped);
  angle += angle < -kPi ? all(2 * kPi) : all(0);
  return angle - (angle >= kPi ? all(2 * kPi) : all(0));
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
