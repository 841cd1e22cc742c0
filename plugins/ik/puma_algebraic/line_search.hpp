// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace armature {

/// Maximum of `f` on [a, c] by golden section, given up as soon as f reaches `enough`.
template <class F>
double golden_maximum(double a, double c, double enough, const F& f) {
  constexpr double kGolden = 0.6180339887498949;
  double left = c - kGolden * (c - a), right = a + kGolden * (c - a);
  double at_left = f(left), at_right = f(right);
  for (int i = 0; i < 40; ++i) {
    if (at_left >= enough) return left;
    if (at_right >= enough) return right;
    if (at_left > at_right) {
      c = right, right = left, at_right = at_left;
      left = c - kGolden * (c - a), at_left = f(left);
    } else {
      a = left, left = right, at_left = at_right;
      right = a + kGolden * (c - a), at_right = f(right);
    }
  }
  return at_left > at_right ? left : right;
}

/// Zero of `f` between a and c, where its signs differ (Brent 1973, zeroin).
template <class F>
double bracketed_zero(double a, double fa, double b, double fb, const F& f) {
  double c = a, fc = fa, step = b - a, before = step;
  for (int i = 0; i < 100; ++i) {
    if (std::abs(fc) < std::abs(fb)) a = b, b = c, c = a, fa = fb, fb = fc, fc = fa;
    const double tolerance = 2e-16 * std::abs(b) + 1e-17, middle = 0.5 * (c - b);
    if (std::abs(middle) <= tolerance || fb == 0) return b;
    if (std::abs(before) < tolerance || std::abs(fa) <= std::abs(fb)) {
      step = before = middle;
    } else {
      const double s = fb / fa;
      double p = 2 * middle * s, q = 1 - s;
      if (a != c) {  // three points: inverse quadratic
        const double r = fb / fc, t = fa / fc;
        p = s * (2 * middle * t * (t - r) - (b - a) * (r - 1));
        q = (t - 1) * (r - 1) * (s - 1);
      }
      if (p > 0) q = -q;
      p = std::abs(p);
      if (2 * p < std::min(3 * middle * q - std::abs(tolerance * q), std::abs(before * q))) {
        before = step, step = p / q;
      } else {
        step = before = middle;
      }
    }
    a = b, fa = fb;
    b += std::abs(step) > tolerance ? step : std::copysign(tolerance, middle);
    fb = f(b);
    if (!std::isfinite(fb)) return b;
    if (std::signbit(fb) == std::signbit(fc)) c = a, fc = fa, step = before = b - a;
  }
  return b;
}

}  // namespace armature
