// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/time_law.hpp"

#include <algorithm>
#include <cmath>

namespace armature {

// With x = t/T, V = speed T, A = acceleration T^2 the quintic to rest at s = 1 has
//   ds/dx = (1 - x)^2 (V + (A + 2 V) x + (30 - 15 V - 2.5 A) x^2),
// which is nowhere negative on [0, 1] when 0 <= V <= 10/3 and -2 V <= A <= 20 - 8 V. What is left
// of a rest-to-rest law at any time lies inside: V goes to 3 and A to -6 at its end.
TimeLaw::TimeLaw(double duration_s, double speed, double acceleration) : duration_s_{duration_s} {
  const double T = duration_s;
  const double V = std::clamp(speed * T, 0.0, 10.0 / 3);
  const double A = std::clamp(acceleration * T * T, -2 * V, std::max(20 - 8 * V, -2 * V));
  law_ = Quintic::between({0, V / T, A / (T * T)}, {1, 0, 0}, T);
}

double TimeLaw::time_at(double s) const {
  if (s <= 0) return 0;
  if (s >= 1) return duration_s_;
  double before = 0, behind = duration_s_;
  double t = 0.5 * duration_s_;
  for (int i = 0; i < 60; ++i) {  // Newton's step when it stays inside the bracket, else half of it
    const double ahead = law_.position(t) - s;
    (ahead < 0 ? before : behind) = t;
    const double newton = t - ahead / law_.velocity(t);
    const double next = newton > before && newton < behind ? newton : 0.5 * (before + behind);
    if (std::abs(next - t) <= 1e-15 * duration_s_) break;
    t = next;
  }
  return t;
}

}  // namespace armature
