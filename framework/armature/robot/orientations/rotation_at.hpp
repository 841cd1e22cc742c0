// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>

namespace armature ARMATURE_EXPORT {

// Differences like t - sin t lose digits when t is small: there, powers of t^2.
namespace rotation_series {

inline constexpr double kBelow = 0.5;  // [rad]
using Terms = std::array<double, 7>;   // the next is below 1e-17 of the first

constexpr double factorial(std::size_t n) {
  double product = 1;
  for (std::size_t i = 2; i <= n; ++i) product *= static_cast<double>(i);
  return product;
}

/// sum (-1)^k t^(2k) / (2k + shift)!
constexpr Terms alternating(std::size_t shift) {
  Terms terms{};
  for (std::size_t k = 0; k < terms.size(); ++k) {
    terms[k] = (k % 2 == 0 ? 1 : -1) / factorial(2 * k + shift);
  }
  return terms;
}

/// (d/dt of that) / t
constexpr Terms slope(std::size_t shift) {
  Terms terms{};
  for (std::size_t k = 1; k <= terms.size(); ++k) {
    terms[k - 1] = (k % 2 == 0 ? 2.0 : -2.0) * static_cast<double>(k) / factorial(2 * k + shift);
  }
  return terms;
}

inline constexpr Terms kB = alternating(3), kSlopeA = slope(2), kSlopeB = slope(3);
/// (1 - t/2 cot(t/2)) / t^2: Bernoulli numbers B_2k / (2k)!
inline constexpr Terms kInverse{1.0 / 12,         1.0 / 720,      1.0 / 30240,
                                1.0 / 1209600,    1.0 / 47900160, 691.0 / 1307674368000,
                                1.0 / 74724249600};

/// In pairs, none of which waits for the one before.
inline double sum(const Terms& c, double t2) {
  const double t4 = t2 * t2;
  return (c[0] + c[1] * t2) + t4 * ((c[2] + c[3] * t2) + t4 * ((c[4] + c[5] * t2) + t4 * c[6]));
}

}  // namespace rotation_series

/// What turns by a rotation vector P and by its changes: exp(P) and its Jacobians at one P, with
/// t = |P|. All of it is real-time safe, and inline: a sample of an orientation is little else.
class RotationAt {
 public:
  explicit RotationAt(const Eigen::Vector3d& P) : RotationAt{P, P.norm()} {}

  /// rotation_of(P).
  Eigen::Quaterniond rotation() const {
    const Eigen::Vector3d vector = half_sinc_ * P_;
    return {half_cos_, vector.x(), vector.y(), vector.z()};
  }
  /// J_l(P) dP, the angular velocity in the frame in which P is told when P changes with dP:
  /// J_l = I + a [P] + b [P]^2, a = (1 - cos t)/t^2, b = (t - sin t)/t^3. It is not dP.
  Eigen::Vector3d velocity(const Eigen::Vector3d& dP) const {
    const Eigen::Vector3d across = P_.cross(dP);
    return dP + a_ * across + b_ * P_.cross(across);
  }
  /// The angular acceleration J_l(P) ddP + (d/du J_l(P)) dP.
  Eigen::Vector3d acceleration(const Eigen::Vector3d& dP, const Eigen::Vector3d& ddP) const {
    const double t2 = t_ * t_;
    // (da/dt)/t and (db/dt)/t
    const double slope_a = small() ? rotation_series::sum(rotation_series::kSlopeA, t2)
                                   : 2 * (half_sinc_ * half_cos_ - a_) / t2;
    const double slope_b =
        small() ? rotation_series::sum(rotation_series::kSlopeB, t2) : (a_ - 3 * b_) / t2;
    const double along = P_.dot(dP);
    const Eigen::Vector3d across = P_.cross(dP);
    return ddP + P_.cross(a_ * ddP + b_ * P_.cross(ddP) + along * slope_b * across) +
           along * slope_a * across + b_ * dP.cross(across);
  }
  /// The dP with velocity(dP) == `velocity`; t must be below 2 pi.
  Eigen::Vector3d rate_of(const Eigen::Vector3d& velocity) const {
    const double t2 = t_ * t_;
    const double c = small() ? rotation_series::sum(rotation_series::kInverse, t2)
                             : (1 - 0.5 * half_cos_ / half_sinc_) / t2;
    const Eigen::Vector3d across = P_.cross(velocity);
    return velocity - 0.5 * across + c * P_.cross(across);
  }

 private:
  RotationAt(const Eigen::Vector3d& P, double t)
      : RotationAt{P, t, std::cos(0.5 * t), std::sin(0.5 * t)} {}
  RotationAt(const Eigen::Vector3d& P, double t, double half_cos, double half_sine)
      : P_{P},
        t_{t},
        half_cos_{half_cos},
        half_sinc_{t > 0 ? half_sine / t : 0.5},
        a_{2 * half_sinc_ * half_sinc_},
        b_{small() ? rotation_series::sum(rotation_series::kB, t * t)
                   : (1 - 2 * half_sinc_ * half_cos) / (t * t)} {}
  bool small() const { return t_ < rotation_series::kBelow; }

  Eigen::Vector3d P_;
  double t_, half_cos_, half_sinc_;  // sin(t/2)/t
  double a_, b_;                     // of [P] and [P]^2 in J_l
};

}  // namespace armature
