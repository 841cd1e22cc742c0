// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/orientations/squad.hpp"

#include <cmath>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/orientations/slerp_weight.hpp"

namespace armature {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// The vector part of p q^-1.
[[gnu::always_inline]] inline Vector3d turned_back(const Vector4d& p, const Vector4d& q) {
  return {q.w() * p.x() - p.w() * q.x() - (p.y() * q.z() - p.z() * q.y()),
          q.w() * p.y() - p.w() * q.y() - (p.z() * q.x() - p.x() * q.z()),
          q.w() * p.z() - p.w() * q.z() - (p.x() * q.y() - p.y() * q.x())};
}

}  // namespace

SquadPiece::Arc::Arc(const Quaterniond& first, const Quaterniond& last) : from{first.coeffs()} {
  const Vector3d turn = double_logarithm(first.conjugate() * last);
  const Vector3d axis = turn.stableNormalized();
  across = (first * Quaterniond{0, axis.x(), axis.y(), axis.z()}).coeffs();
  half_angle = 0.5 * turn.stableNorm();
}

[[gnu::always_inline]] inline SquadPiece::Point::Point(const Arc& arc, double x) {
  const double angle = x * arc.half_angle, sine = std::sin(angle), cosine = std::cos(angle);
  q = cosine * arc.from + sine * arc.across;
  rate = arc.half_angle * (cosine * arc.across - sine * arc.from);
}

SquadPiece::SquadPiece(const Quaterniond& key, const Quaterniond& inner,
                       const Quaterniond& next_inner, const Quaterniond& next_key, double duration)
    : keys_{key, next_key}, inners_{inner, next_inner}, duration_{duration} {}

template <Rates rates>
OrientationState SquadPiece::at(double x) const {
  // r = A a + B b, weights A = W(1 - k, u), B = W(k, u), with a and b on the two arcs, u = a . b
  // and k = 2 x (1 - x). Rates are by x until the end.
  const Point a{keys_, x}, b{inners_, x};
  const double u = a.q.dot(b.q), k = 2 * x * (1 - x);
  const SlerpAngle between{u, (b.q - u * a.q).norm()};
  const double sine = std::sin(k * between.theta), cosine = std::cos(k * between.theta);
  const SlerpWeight to_b{between, k, sine, cosine, rates};
  const SlerpWeight to_a{between, 1 - k, between.sine * cosine - between.cosine * sine,
                         between.cosine * cosine + between.sine * sine, rates};
  const Vector4d r = to_a.w * a.q + to_b.w * b.q;
  if constexpr (rates == Rates::none) return {.rotation = Quaterniond{r}};

  const double u1 = a.rate.dot(b.q) + a.q.dot(b.rate), k1 = 2 - 4 * x;
  const double A1 = to_a.w_u * u1 - to_a.w_k * k1, B1 = to_b.w_u * u1 + to_b.w_k * k1;
  const Vector4d r1 = A1 * a.q + to_a.w * a.rate + B1 * b.q + to_b.w * b.rate;
  const double by_time = 1 / duration_;
  const Vector3d velocity = 2 * by_time * turned_back(r1, r);
  if constexpr (rates == Rates::velocity) return {.rotation = Quaterniond{r}, .velocity = velocity};

  const double a_h2 = keys_.half_angle * keys_.half_angle;  // a'' = -h^2 a
  const double b_h2 = inners_.half_angle * inners_.half_angle;
  const double u2 = 2 * a.rate.dot(b.rate) - (a_h2 + b_h2) * u, k2 = -4;
  const auto second = [&](const SlerpWeight& w, double dk, double ddk) {
    return w.w_kk * dk * dk + 2 * w.w_ku * dk * u1 + w.w_uu * u1 * u1 + w.w_k * ddk + w.w_u * u2;
  };
  const double A2 = second(to_a, -k1, -k2), B2 = second(to_b, k1, k2);
  const Vector4d r2 =
      (A2 - a_h2 * to_a.w) * a.q + 2 * A1 * a.rate + (B2 - b_h2 * to_b.w) * b.q + 2 * B1 * b.rate;
  return {Quaterniond{r}, velocity, 2 * by_time * by_time * turned_back(r2, r)};
}

template OrientationState SquadPiece::at<Rates::none>(double) const;
template OrientationState SquadPiece::at<Rates::velocity>(double) const;
template OrientationState SquadPiece::at<Rates::acceleration>(double) const;

}  // namespace armature
