// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace armature {

/// Sine and cosine of an angle.
struct SinCos {
  double sin = 0, cos = 1;

  static SinCos of(double angle) { return {std::sin(angle), std::cos(angle)}; }
  SinCos operator-() const { return {-sin, cos}; }
  SinCos half_turn_on() const { return {-sin, -cos}; }
  SinCos operator+(const SinCos& o) const {
    return {sin * o.cos + cos * o.sin, cos * o.cos - sin * o.sin};
  }
  SinCos operator-(const SinCos& o) const { return *this + -o; }
  double angle() const { return std::atan2(sin, cos); }
};

/// Three turns about axes through one point, as the arm angle moves them: both the shoulder and the
/// wrist of an S-R-S arm are
///
///   Rz(a) Ry(b) Rz(c) = Ry(p) Rz(x) Ry(q)
///
/// with p and q fixed by the goal and x the arm angle, or what is left of a constant less the arm
/// angle: the spherical triangle of sides p, q, b. The other solution is a + pi, -b, c + pi.
struct BallJoint {
  SinCos p, q;
};

/// a, b >= 0 and c at one x.
struct BallAngles {
  SinCos a, b, c;
  /// sin(b) is zero: only a + c (or a - c) is determined, and a is what was asked to be kept.
  bool free = false;

  BallAngles flipped() const {
    return free ? *this : BallAngles{a.half_turn_on(), -b, c.half_turn_on(), false};
  }
};

/// The angles at `x`; a sine of b below `in_line` is zero and `kept_a` decides.
inline BallAngles angles_at(const BallJoint& ball, const SinCos& x, double in_line, double kept_a) {
  const auto& [p, q] = ball;
  // The third column, of which a and b are spherical coordinates.
  const double m13 = p.cos * q.sin * x.cos + p.sin * q.cos, m23 = q.sin * x.sin;
  const double m33 = p.cos * q.cos - p.sin * q.sin * x.cos;
  const double sin_b = std::sqrt(m13 * m13 + m23 * m23);
  BallAngles angles;
  angles.free = sin_b < in_line;
  if (angles.free) {
    angles.a = SinCos::of(kept_a);
    angles.b = {0, m33 < 0 ? -1.0 : 1.0};
  } else {
    angles.a = {m23 / sin_b, m13 / sin_b};
    angles.b = {sin_b, m33};
  }
  // c out of what Rz(-a) leaves of the second row: exact however small sin(b) is.
  const double m11 = p.cos * x.cos * q.cos - p.sin * q.sin, m21 = x.sin * q.cos;
  const double m12 = -p.cos * x.sin, m22 = x.cos;
  angles.c = {angles.a.cos * m21 - angles.a.sin * m11, angles.a.cos * m22 - angles.a.sin * m12};
  return angles;
}

}  // namespace armature
