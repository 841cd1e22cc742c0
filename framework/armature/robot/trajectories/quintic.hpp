// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace armature ARMATURE_EXPORT {

/// q(t) = c0 + c1 t + ... + c5 t^5, t in [s] from the start of the piece. Real-time safe.
struct Quintic {
  std::array<double, 6> c{};

  double position(double t) const;
  double velocity(double t) const;
  double acceleration(double t) const;
  double jerk(double t) const;

  struct End {
    double q = 0, v = 0, a = 0;
  };
  /// The quintic that leaves `from` at t = 0 and meets `to` at t = duration_s > 0
  /// (Jiang et al. 2021, (48)-(53); rest to rest: 10 D, -15 D, 6 D).
  static Quintic between(const End& from, const End& to, double duration_s);
  /// The same curve with t = 0 moved to `t0`.
  Quintic shifted(double t0) const;
};

/// Largest |velocity| and |acceleration| of a quintic on [0, duration_s], from the roots of its
/// derivatives (exact to rounding, not sampled).
struct QuinticPeaks {
  double velocity = 0, acceleration = 0;
};
QuinticPeaks peaks(const Quintic& quintic, double duration_s);

/// Largest |jerk| of a quintic on [0, duration_s], as exact as the peaks.
double peak_jerk(const Quintic& quintic, double duration_s);

/// Lowest and highest position of a quintic on [0, duration_s], as exact as the peaks.
struct QuinticRange {
  double lowest = 0, highest = 0;
};
QuinticRange range(const Quintic& quintic, double duration_s);

}  // namespace armature
