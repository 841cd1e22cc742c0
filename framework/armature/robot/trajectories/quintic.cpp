// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/quintic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace armature {
namespace {

/// Real roots of k0 + k1 t + k2 t^2 inside (0, end), ascending; a double root may be left out (the
/// curve only touches zero there).
struct Roots {
  std::array<double, 2> t{};
  int count = 0;

  void add_inside(double root, double end) {
    if (root > 0 && root < end) t[static_cast<std::size_t>(count++)] = root;
  }
};

Roots quadratic_roots(double k0, double k1, double k2, double end) {
  Roots roots;
  const double discriminant = k1 * k1 - 4 * k0 * k2;
  if (discriminant < 0) return roots;
  // The sum that does not cancel; the other root follows from the product of both.
  const double sum = -0.5 * (k1 + std::copysign(std::sqrt(discriminant), k1));
  if (k2 != 0) roots.add_inside(sum / k2, end);
  if (sum != 0) roots.add_inside(k0 / sum, end);
  if (roots.count == 2 && roots.t[0] > roots.t[1]) std::swap(roots.t[0], roots.t[1]);
  return roots;
}

/// The root of `f` between a and b, where it has opposite signs: Newton's steps, halves of what is
/// left where one leaves it or is no shorter than half of the last. What `f` is the derivative of
/// is exact there to rounding (it is flat).
template <class Function, class Slope>
double root_between(double a, double b, Function f, Slope slope) {
  const bool rising = f(a) < 0;
  const double enough = 1e-7 * (b - a);  // what is flat is wrong by the square of that
  double t = 0.5 * (a + b), last_step = b - a;
  for (int i = 0; i < 64 && std::abs(last_step) > enough; ++i) {
    const double value = f(t);
    if (value == 0) return t;
    ((value < 0) == rising ? a : b) = t;
    double next = t - value / slope(t);
    const bool converges = next > a && next < b && std::abs(next - t) < 0.5 * std::abs(last_step);
    if (!converges) next = 0.5 * (a + b);
    last_step = next - t;
    t = next;
  }
  return t;
}

double acceleration_root(const Quintic& quintic, double a, double b) {
  return root_between(
      a, b, [&](double t) { return quintic.acceleration(t); },
      [&](double t) { return quintic.jerk(t); });
}

double velocity_root(const Quintic& quintic, double a, double b) {
  return root_between(
      a, b, [&](double t) { return quintic.velocity(t); },
      [&](double t) { return quintic.acceleration(t); });
}

}  // namespace

double Quintic::position(double t) const {
  return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

double Quintic::velocity(double t) const {
  return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
}

double Quintic::acceleration(double t) const {
  return 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]));
}

double Quintic::jerk(double t) const { return 6 * c[3] + t * (24 * c[4] + t * 60 * c[5]); }

Quintic Quintic::between(const End& from, const End& to, double duration_s) {
  const double T = duration_s;
  const double D = to.q - from.q;
  // (52), (53) solved by hand, in units of the duration.
  const double v0 = from.v * T, v1 = to.v * T;
  const double a0 = from.a * T * T, a1 = to.a * T * T;
  const double T3 = T * T * T;
  return {{from.q, from.v, 0.5 * from.a,  //
           (10 * D - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1) / T3,
           (-15 * D + 8 * v0 + 7 * v1 + 1.5 * a0 - a1) / (T3 * T),
           (6 * D - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1) / (T3 * T * T)}};
}

Quintic Quintic::shifted(double t0) const {
  // Taylor coefficients at t0 by repeated synthetic division.
  Quintic result = *this;
  for (std::size_t first = 0; first < 5; ++first)
    for (std::size_t i = 5; i-- > first;) result.c[i] += t0 * result.c[i + 1];
  return result;
}

QuinticPeaks peaks(const Quintic& quintic, double duration_s) {
  const double T = duration_s;
  QuinticPeaks result{
      .velocity = std::max(std::abs(quintic.velocity(0)), std::abs(quintic.velocity(T))),
      .acceleration =
          std::max(std::abs(quintic.acceleration(0)), std::abs(quintic.acceleration(T)))};
  const Roots flat =
      quadratic_roots(6 * quintic.c[3], 24 * quintic.c[4], 60 * quintic.c[5], T);  // jerk = 0

  // Between those the acceleration is monotone: at most one zero each, where the velocity peaks.
  double from = 0;
  for (int i = 0; i <= flat.count; ++i) {
    const double to = i < flat.count ? flat.t[static_cast<std::size_t>(i)] : T;
    const double a = quintic.acceleration(from), b = quintic.acceleration(to);
    result.acceleration = std::max(result.acceleration, std::abs(b));
    if ((a < 0) != (b < 0))
      result.velocity = std::max(result.velocity,
                                 std::abs(quintic.velocity(acceleration_root(quintic, from, to))));
    from = to;
  }
  return result;
}

double peak_jerk(const Quintic& quintic, double duration_s) {
  double peak = std::max(std::abs(quintic.jerk(0)), std::abs(quintic.jerk(duration_s)));
  const double vertex = -24 * quintic.c[4] / (120 * quintic.c[5]);
  if (vertex > 0 && vertex < duration_s) peak = std::max(peak, std::abs(quintic.jerk(vertex)));
  return peak;
}

QuinticRange range(const Quintic& quintic, double duration_s) {
  const double T = duration_s;
  QuinticRange result{quintic.position(0), quintic.position(0)};
  const auto pass = [&](double t) {
    const double q = quintic.position(t);
    result = {std::min(result.lowest, q), std::max(result.highest, q)};
  };
  // Where the acceleration changes sign the velocity turns: between those it has one zero at most.
  double from = 0;
  const auto piece_to = [&](double to) {
    if ((quintic.velocity(from) < 0) != (quintic.velocity(to) < 0)) {
      pass(velocity_root(quintic, from, to));
    }
    pass(to);
    from = to;
  };
  const Roots flat = quadratic_roots(6 * quintic.c[3], 24 * quintic.c[4], 60 * quintic.c[5], T);
  double left = 0;
  for (int i = 0; i <= flat.count; ++i) {
    const double right = i < flat.count ? flat.t[static_cast<std::size_t>(i)] : T;
    if ((quintic.acceleration(left) < 0) != (quintic.acceleration(right) < 0)) {
      piece_to(acceleration_root(quintic, left, right));
    }
    left = right;
  }
  piece_to(T);
  return result;
}

}  // namespace armature
