// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

/// Maximum of `f` on [a, c] by golden section, given up as soon as f reaches 0.
template <class F>
double golden_maximum(double a, double c, const F& f) {
  constexpr double kGolden = 0.6180339887498949;
  double left = c - kGolden * (c - a), right = a + kGolden * (c - a);
  double at_left = f(left), at_right = f(right);
  for (int i = 0; i < 40 && at_left < 0 && at_right < 0; ++i) {
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

/// The last place from `inside`, where `holds`, towards `outside`, where it does not, by halves.
template <class Holds>
double last_where(double inside, double outside, const Holds& holds) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + outside);
    (holds(middle) ? inside : outside) = middle;
  }
  return inside;
}

}  // namespace armature
