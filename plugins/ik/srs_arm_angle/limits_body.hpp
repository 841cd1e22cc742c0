// SPDX-License-Identifier: Apache-2.0
// Where joints reach their limits, and whether they keep them, without an arctangent of a joint;
// see triangles_body.hpp. The entries of M = Ry(p) Rz(x) Ry(q) tell: a and c are arctangents of
// (M23, M13) and (M32, -M31), b is arccos M33.
//   M13 = cos p sin q cos x + sin p cos q    M23 = sin q sin x
//   M31 = -sin p cos q cos x - cos p sin q   M32 = sin p sin x
//   M33 = cos p cos q - sin p sin q cos x
#pragma once

#include <limits>

#include "triangles_body.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

/// The two x with u sin x + v cos x + w = 0; where that only just has none, the x nearest to one;
/// NaN where it has none.
void store_roots(const Lanes& u, const Lanes& v, const Lanes& w, const Triangles& t, double* at) {
  constexpr double kJustNone = 1e-9;
  const Lanes r = root(u * u + v * v);
  const Masks some = (r > 0) & (magnitude(w) <= r * (1 + kJustNone));
  const Lanes middle = arctangent(u, v);
  const Lanes away = arctangent(root(larger((r - w) * (r + w), all(0))), -w);
  const Lanes nothing = all(std::numeric_limits<double>::quiet_NaN());
  for (const Lanes& x : {middle - away, middle + away}) {
    store(some ? wrapped(t.direction * (x - t.start_rad)) : nothing, at);
    at += kLanes;
  }
}

/// Lanes: the shoulder's lower and upper limit, the wrist's lower and upper limit.
[[gnu::flatten]] void limit_angles(const ArmNumbers& arm, const SrsGoal& goal, double (&at)[24]) {
  const Triangles t{goal.shoulder, goal.wrist};
  const auto end = [&](int i) { return LaneSinCos{load(arm.end_sin[i]), load(arm.end_cos[i])}; };
  const LaneSinCos a =
      difference(end(0), Triangles::both(goal.shoulder.shift_a, goal.wrist.shift_a));
  const LaneSinCos b = end(1);
  const LaneSinCos c =
      difference(end(2), Triangles::both(goal.shoulder.shift_c, goal.wrist.shift_c));
  store_roots(t.q.sin * a.cos, -t.cos_sin * a.sin, -t.sin_cos * a.sin, t, at);
  store_roots(all(0), -t.sin_sin, t.cos_cos - b.cos, t, at + 8);
  store_roots(t.p.sin * c.cos, -t.sin_cos * c.sin, -t.cos_sin * c.sin, t, at + 16);
}

/// A joint's turn keeps its limits where sin(distance from the middle - half) <= 0.
struct Range {
  LaneSinCos middle, half;

  Range(const ArmNumbers& arm, int joint, const SinCos& shift)
      : middle{difference(everywhere(arm.middle_turn[joint]), everywhere(shift))},
        half{everywhere(arm.half_turn[joint])} {}
  /// Of a turn with sine y and cosine x (or both times a length), as it is and half a turn on.
  void hold(const Lanes& y, const Lanes& x, Masks& as_is, Masks& half_turned) const {
    const Lanes across = magnitude(y * middle.cos - x * middle.sin) * half.cos;
    const Lanes along = (x * middle.cos + y * middle.sin) * half.sin;
    as_is = across <= along;
    half_turned = across <= -along;
  }
};

/// Which solutions of a shoulder or a wrist keep their limits, by elbow and flip.
class LimitedBall {
 public:
  LimitedBall(const ArmNumbers& arm, const Triangle& triangle, int first)
      : is_wrist_{first != 0},
        t_{triangle},
        a_{arm, first, triangle.shift_a},
        b_{arm, first + 1, {}},
        c_{arm, first + 2, triangle.shift_c} {}

  void keeps(const LaneSinCos& arm_angle, Masks (&by)[2][2]) const {
    const LaneSinCos x = t_.x_at(arm_angle);
    const Lanes m13 = t_.cos_sin * x.cos + t_.sin_cos, m23 = t_.q.sin * x.sin;
    const Lanes minus_m31 = t_.sin_cos * x.cos + t_.cos_sin, m32 = t_.p.sin * x.sin;
    const Lanes m33 = t_.cos_cos - t_.sin_sin * x.cos;
    const Lanes sin_b = root(m13 * m13 + m23 * m23);
    Masks a[2], b[2], c[2], unused;
    a_.hold(m23, m13, a[0], a[1]);
    c_.hold(m32, minus_m31, c[0], c[1]);
    b_.hold(sin_b, m33, b[0], unused);
    b_.hold(-sin_b, m33, b[1], unused);
    for (int flip = 0; flip < 2; ++flip) {
      by[0][flip] = a[flip] & b[flip] & c[flip];
      by[1][flip] = b[flip] & (is_wrist_ ? a[1 - flip] & c[flip] : a[flip] & c[1 - flip]);
    }
  }

 private:
  bool is_wrist_;
  Triangles t_;
  Range a_, b_, c_;
};

[[gnu::flatten]] void keep_limits(const ArmNumbers& arm, const SrsGoal& goal, const double* at,
                                  int count, std::uint64_t (&kept)[8]) {
  const LimitedBall shoulder{arm, goal.shoulder, 0}, wrist{arm, goal.wrist, 4};
  std::memset(kept, 0, sizeof kept);
  for (int i = 0; i < count; i += kLanes) {
    const LaneSinCos arm_angle = sine_and_cosine(load(at + i));
    Masks by_shoulder[2][2], by_wrist[2][2];
    shoulder.keeps(arm_angle, by_shoulder);
    wrist.keeps(arm_angle, by_wrist);
    for (int branch = 0; branch < 8; ++branch) {
      const int elbow = branch / 2 % 2;
      const Masks both = by_shoulder[elbow][branch / 4] & by_wrist[elbow][branch % 2];
      kept[branch] |= std::uint64_t{bits_of(both)} << i;
    }
  }
}

}  // namespace
}  // namespace armature::ik::srs_arm_angle
