// SPDX-License-Identifier: Apache-2.0
// Arithmetic on four doubles at once, for descent_body.hpp: unnamed on purpose, as that is.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "descent.hpp"

namespace armature::descent {
namespace {

using Words = std::int64_t __attribute__((vector_size(32)));

inline double dot(const Lanes& a, const Lanes& b) {
  const Lanes p = a * b;
  return p[0] + p[1] + p[2];
}

inline Lanes cross(const Lanes& a, const Lanes& b) {
  const Lanes turned_a = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Lanes turned_b = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Lanes result = a * turned_b - turned_a * b;
  return __builtin_shufflevector(result, result, 1, 2, 0, 3);
}

/// Sine and cosine of four angles of at most 1e5 rad, wrong by less than 2 units in the last place:
/// reduced by quarter turns (three parts of pi/2), then the polynomials of W. J. Cody and W. Waite,
/// "Software Manual for the Elementary Functions", 1980, with the coefficients of Sun's fdlibm.
inline void sine_and_cosine(const double* angle, double* sine, double* cosine) {
  constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  Lanes x;
  std::memcpy(&x, angle, sizeof x);
  const Lanes rounded = x * 0.63661977236758134308 + kRounder;
  const Words quarter = std::bit_cast<Words>(rounded);
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
  const Words odd = -(quarter & 1);
  const Words sine_sign = (quarter & 2) << 62, cosine_sign = ((quarter + 1) & 2) << 62;
  const Words sw = std::bit_cast<Words>(s), cw = std::bit_cast<Words>(c);
  const Words sine_bits = ((cw & odd) | (sw & ~odd)) ^ sine_sign;
  const Words cosine_bits = ((sw & odd) | (cw & ~odd)) ^ cosine_sign;
  std::memcpy(sine, &sine_bits, sizeof sine_bits);
  std::memcpy(cosine, &cosine_bits, sizeof cosine_bits);
}

}  // namespace
}  // namespace armature::descent
