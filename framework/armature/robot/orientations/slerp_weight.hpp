// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "armature/robot/orientations/orientation_state.hpp"

namespace armature ARMATURE_EXPORT {

/// Between two unit quaternions a and b: how far they are apart as points of the sphere S^3.
struct SlerpAngle {
  double cosine, sine;  // of theta; a . b and |b - (a . b) a|
  double theta;         // [rad], from 0 to pi
  double by_sine;       // 1 / sine; 0 where there is no angle

  SlerpAngle(double cosine_of, double sine_of)
      : cosine{cosine_of},
        sine{sine_of},
        theta{std::atan2(sine_of, cosine_of)},
        by_sine{sine_of > 0 ? 1 / sine_of : 0} {}
  /// Quotients of differences would lose digits here: what is lost of a rate is 1e-16 / theta^2.
  bool small() const { return sine < 0.1 && cosine > 0; }
};

/// W(k, u) = sin(k theta) / sin(theta) with u = cos(theta): slerp(a, b, k) is
/// W(1 - k, u) a + W(k, u) b. And its partial derivatives, for slerps between points that move: W
/// is the Chebyshev function U_{k-1}(u), so (1 - u^2) W_uu = 3 u W_u - (k^2 - 1) W. Inline, and
/// without a sine of its own. Real-time safe.
struct SlerpWeight {
  double w = 0, w_k = 0, w_u = 0, w_kk = 0, w_ku = 0, w_uu = 0;

  /// `sine` and `cosine` of k theta; the derivatives that the rates of a slerp need.
  [[gnu::always_inline]] SlerpWeight(const SlerpAngle& between, double k, double sine,
                                     double cosine, Rates rates) {
    const bool apart = between.sine > 0;
    w = apart ? sine * between.by_sine : k;
    if (rates == Rates::none) return;
    const double theta = between.theta, u = between.cosine;
    w_k = apart ? theta * between.by_sine * cosine : 1;
    w_kk = -theta * theta * w;
    if (between.small()) {
      differentiate_near_one(k, between.sine * between.sine / (2 * (1 + u)));
      return;
    }
    const double by_s2 = between.by_sine * between.by_sine;
    w_u = (w * u - k * cosine) * by_s2;
    w_ku = (w_k * u - cosine + k * theta * sine) * by_s2;
    w_uu = (3 * u * w_u - (k * k - 1) * w) * by_s2;
  }

 private:
  /// W = k 2F1(1 - k, 1 + k; 3/2; z) with z = (1 - u) / 2, term by term; z is below 0.0026.
  void differentiate_near_one(double k, double z) {
    constexpr std::array<double, 6> kBy{1 / 1.5, 1 / 5.0, 1 / 10.5, 1 / 18.0, 1 / 27.5, 1 / 39.0};
    double c = 1, c_k = 0;                      // the coefficient of z^m, and its derivative by k
    double first = 0, first_k = 0, second = 0;  // d/dz and so on of the sum
    double power = 1, below = 0;                // z^(m-1), z^(m-2)
    for (std::size_t i = 0; i < kBy.size(); ++i) {
      const double m = static_cast<double>(i) + 1, factor = (m * m - k * k) * kBy[i];
      c_k = c_k * factor - 2 * k * kBy[i] * c;
      c *= factor;
      first += m * c * power;
      first_k += m * c_k * power;
      second += m * (m - 1) * c * below;
      below = power;
      power *= z;
    }
    w_u = -0.5 * k * first;
    w_ku = -0.5 * (first + k * first_k);
    w_uu = 0.25 * k * second;
  }
};

}  // namespace armature
