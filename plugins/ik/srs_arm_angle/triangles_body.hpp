// SPDX-License-Identifier: Apache-2.0
// The spherical triangles of shoulders and wrists (Triangle), four at once. Bodies are compiled
// once for each kind of processor (arm_kernel.cpp), everything unnamed so that they never mix.
#pragma once

#include <cstring>

#include "arm_kernel.hpp"
#include "armature/kinds/ik/lanes.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

static_assert(kLanes == 4);

inline Lanes load(const double* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store(const Lanes& from, double* to) { std::memcpy(to, &from, sizeof from); }

inline LaneSinCos everywhere(const SinCos& turn) { return {all(turn.sin), all(turn.cos)}; }
inline LaneSinCos pick(const Masks& which, const LaneSinCos& a, const LaneSinCos& b) {
  return {which ? a.sin : b.sin, which ? a.cos : b.cos};
}
inline LaneSinCos difference(const LaneSinCos& a, const LaneSinCos& b) {
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}
inline LaneSinCos negated(const LaneSinCos& turn) { return {-turn.sin, -turn.cos}; }
inline Lanes angle_of(const LaneSinCos& turn) { return arctangent(turn.sin, turn.cos); }

struct Triangles {
  LaneSinCos p, q, start, kept_a;
  Lanes start_rad, direction;
  Lanes cos_cos, cos_sin, sin_cos, sin_sin;  // of p and q

  /// Lanes 0 and 1 are `low`, 2 and 3 `high`.
  Triangles(const Triangle& low, const Triangle& high)
      : p{both(low.p, high.p)},
        q{both(low.q, high.q)},
        start{both(low.start, high.start)},
        kept_a{both(low.kept_a, high.kept_a)},
        start_rad{low.start_rad, low.start_rad, high.start_rad, high.start_rad},
        direction{low.direction, low.direction, high.direction, high.direction},
        cos_cos{p.cos * q.cos},
        cos_sin{p.cos * q.sin},
        sin_cos{p.sin * q.cos},
        sin_sin{p.sin * q.sin} {}
  explicit Triangles(const Triangle& one) : Triangles{one, one} {}

  static LaneSinCos both(const SinCos& low, const SinCos& high) {
    return {Lanes{low.sin, low.sin, high.sin, high.sin},
            Lanes{low.cos, low.cos, high.cos, high.cos}};
  }
  /// x at an arm angle.
  LaneSinCos x_at(const LaneSinCos& arm_angle) const {
    const Lanes turned = direction * arm_angle.sin;
    return {start.sin * arm_angle.cos + start.cos * turned,
            start.cos * arm_angle.cos - start.sin * turned};
  }
};

/// a, b >= 0 and c; where axes are collinear a is kept and b is 0 or pi.
struct Angles {
  LaneSinCos a, b, c;
  Masks collinear;
  Lanes inverse_sine;  // of b; 1 where the axes are collinear
};
inline Angles angles_at(const Triangles& t, const LaneSinCos& arm_angle, double collinear) {
  const LaneSinCos x = t.x_at(arm_angle);
  const Lanes m13 = t.cos_sin * x.cos + t.sin_cos, m23 = t.q.sin * x.sin;
  Angles angles;
  angles.b = {root(m13 * m13 + m23 * m23), t.cos_cos - t.sin_sin * x.cos};
  angles.collinear = angles.b.sin < all(collinear);
  angles.inverse_sine = 1 / (angles.collinear ? all(1) : angles.b.sin);
  angles.a = {m23 * angles.inverse_sine, m13 * angles.inverse_sine};
  if (any(angles.collinear)) {
    const LaneSinCos flat{all(0), angles.b.cos < 0 ? all(-1) : all(1)};
    angles.a = pick(angles.collinear, t.kept_a, angles.a);
    angles.b = pick(angles.collinear, flat, angles.b);
  }
  // The second row of Rz(-a) M has length 1 however small sin b is.
  const Lanes m11 = t.cos_cos * x.cos - t.sin_sin, m21 = t.q.cos * x.sin;
  angles.c = {angles.a.cos * m21 - angles.a.sin * m11,
              angles.a.cos * x.cos + angles.a.sin * (t.p.cos * x.sin)};
  return angles;
}

}  // namespace
}  // namespace armature::ik::srs_arm_angle
