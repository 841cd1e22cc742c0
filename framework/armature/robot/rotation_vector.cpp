// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/rotation_vector.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace armature {
namespace {

// Below, differences like t - sin t lose digits: powers of t^2 instead.
constexpr double kSeriesBelow = 0.5;
constexpr std::size_t kTerms = 7;  // the next is below 1e-17 of the first
using Series = std::array<double, kTerms>;

constexpr double factorial(std::size_t n) {
  double product = 1;
  for (std::size_t i = 2; i <= n; ++i) product *= static_cast<double>(i);
  return product;
}

/// sum (-1)^k t^(2k) / (2k + shift)!
constexpr Series series(std::size_t shift) {
  Series terms{};
  for (std::size_t k = 0; k < kTerms; ++k) {
    terms[k] = (k % 2 == 0 ? 1 : -1) / factorial(2 * k + shift);
  }
  return terms;
}

/// (d/dt of it) / t
constexpr Series slope(std::size_t shift) {
  Series terms{};
  for (std::size_t k = 1; k <= kTerms; ++k) {
    terms[k - 1] = (k % 2 == 0 ? 2.0 : -2.0) * static_cast<double>(k) / factorial(2 * k + shift);
  }
  return terms;
}

double sum(const Series& terms, double t2) {
  double value = terms.back();
  for (std::size_t k = kTerms - 1; k-- > 0;) value = value * t2 + terms[k];
  return value;
}

constexpr Series kB = series(3), kSlopeA = slope(2), kSlopeB = slope(3);

}  // namespace

Eigen::Vector3d double_logarithm(const Eigen::Quaterniond& unit) {
  const double sine = unit.vec().norm();
  if (sine == 0) return 2 * unit.vec();
  return 2 * std::atan2(sine, unit.w()) / sine * unit.vec();
}

Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& unit) {
  if (unit.w() >= 0) return double_logarithm(unit);
  return double_logarithm(Eigen::Quaterniond{-unit.coeffs()});
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& P) {
  const double t = P.norm();
  const Eigen::Vector3d vector = (t > 0 ? std::sin(0.5 * t) / t : 0.5) * P;
  return {std::cos(0.5 * t), vector.x(), vector.y(), vector.z()};
}

RotationAt::RotationAt(const Eigen::Vector3d& P, double t, double half_cos, double half_sine)
    : P_{P},
      t_{t},
      half_cos_{half_cos},
      half_sinc_{t > 0 ? half_sine / t : 0.5},
      a_{2 * half_sinc_ * half_sinc_},
      b_{t < kSeriesBelow ? sum(kB, t * t) : (1 - 2 * half_sinc_ * half_cos) / (t * t)} {}

RotationAt::RotationAt(const Eigen::Vector3d& P, const Eigen::Quaterniond& rotation)
    : RotationAt{P, P.norm(), rotation.w(), rotation.vec().norm()} {}

RotationAt::RotationAt(const Eigen::Vector3d& P, double t)
    : RotationAt{P, t, std::cos(0.5 * t), std::sin(0.5 * t)} {}

RotationAt::RotationAt(const Eigen::Vector3d& P) : RotationAt{P, P.norm()} {}

Eigen::Quaterniond RotationAt::rotation() const {
  const Eigen::Vector3d vector = half_sinc_ * P_;
  return {half_cos_, vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d RotationAt::velocity(const Eigen::Vector3d& dP) const {
  const Eigen::Vector3d across = P_.cross(dP);
  return dP + a_ * across + b_ * P_.cross(across);
}

Eigen::Vector3d RotationAt::acceleration(const Eigen::Vector3d& dP,
                                         const Eigen::Vector3d& ddP) const {
  const double t2 = t_ * t_;
  double slope_a, slope_b;  // (da/dt)/t and (db/dt)/t
  if (t_ < kSeriesBelow) {
    slope_a = sum(kSlopeA, t2);
    slope_b = sum(kSlopeB, t2);
  } else {
    slope_a = 2 * (half_sinc_ * half_cos_ - a_) / t2;
    slope_b = (a_ - 3 * b_) / t2;
  }
  const double along = P_.dot(dP);
  const Eigen::Vector3d across = P_.cross(dP);
  return ddP + P_.cross(a_ * ddP + b_ * P_.cross(ddP) + along * slope_b * across) +
         along * slope_a * across + b_ * dP.cross(across);
}

Eigen::Vector3d RotationAt::rate_of(const Eigen::Vector3d& velocity) const {
  // (1 - t/2 cot(t/2)) / t^2; its series are Bernoulli numbers B_2k / (2k)!.
  constexpr std::array kCot{1.0 / 12,         1.0 / 720,      1.0 / 30240,
                            1.0 / 1209600,    1.0 / 47900160, 691.0 / 1307674368000,
                            1.0 / 74724249600};
  const double t2 = t_ * t_;
  double c = kCot.back();
  if (t_ < kSeriesBelow) {
    for (std::size_t k = kCot.size() - 1; k-- > 0;) c = c * t2 + kCot[k];
  } else {
    c = (1 - 0.5 * half_cos_ / half_sinc_) / t2;
  }
  const Eigen::Vector3d across = P_.cross(velocity);
  return velocity - 0.5 * across + c * P_.cross(across);
}

}  // namespace armature
