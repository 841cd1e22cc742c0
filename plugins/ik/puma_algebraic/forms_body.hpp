// SPDX-License-Identifier: Apache-2.0
// What four arms of one pose and an arm of many poses have in common; see four_arms_body.hpp.
#pragma once

#include <cmath>

#include "armature/kinds/ik/lanes.hpp"
#include "four_arms.hpp"

namespace armature {
namespace {

// Relative to the arm's length: a gap to the rim of reach below kOnRim is rounding, and both roots
// are one; a wrist nearer to the axis of joint 1 or 2 than kOnAxis leaves that joint free.
constexpr double kOnRim = 2e-15, kOnAxis = 1e-12;
// det J = -a2 forearm sin(elbow) (wrist to axis 1) sin(t5): an arm is singular when one of the
// three, each relative to its largest, is below kSingular, or their product below kSingularProduct.
constexpr double kSingular = 1e-6, kSingularProduct = 1e-10;

/// The angle psi = t3 + beta between upper arm and forearm, and the vector to the wrist that both
/// make, seen from the upper arm.
struct Elbows {
  Lanes psi, cos_psi, sin_psi;
  Lanes x, y, length;
};
/// (311), (312) as half angles, whose squares are factored so that nothing cancels; `side`: 1 of
/// elbow 0, -1 of elbow 1.
[[gnu::always_inline]] inline Elbows elbows_at(const ArmNumbers& arm, const Lanes& rho,
                                               const Lanes& side) {
  const double farthest = arm.a2 + arm.forearm, nearest = std::fabs(arm.a2 - arm.forearm);
  Lanes outside = farthest - rho, inside = rho - nearest;
  outside = outside < kOnRim * farthest ? all(0) : outside;
  inside = inside < kOnRim * farthest ? all(0) : inside;
  const Lanes up2 = outside * (farthest + rho), flat2 = inside * (rho + nearest);
  const Lanes up = root(up2), flat = root(flat2);
  const Lanes scale = 1 / (up2 + flat2);  // of 4 a2 forearm
  Elbows elbows;
  elbows.psi = 2 * side * arctangent(up, flat);
  elbows.cos_psi = (flat2 - up2) * scale;
  elbows.sin_psi = 2 * side * up * flat * scale;
  elbows.x = arm.a2 + arm.forearm * elbows.cos_psi;
  elbows.y = arm.forearm * elbows.sin_psi;
  elbows.length = root(elbows.x * elbows.x + elbows.y * elbows.y);
  return elbows;
}

/// The wrist's axes seen from link 3.
struct Axes {
  LaneTriple n, o, a;
};
[[gnu::always_inline]] inline Axes axes_of(const Lanes& c4, const Lanes& s4, const Lanes& c5,
                                           const Lanes& s5, const Lanes& c6, const Lanes& s6) {
  return {{c4 * c5 * c6 - s4 * s6, s5 * c6, -(s4 * c5 * c6) - c4 * s6},
          {-(c4 * c5 * s6) - s4 * c6, -(s5 * s6), s4 * c5 * s6 - c4 * c6},
          {-(c4 * s5), c5, s4 * s5}};
}
[[gnu::always_inline]] inline LaneTriple turn_between(const Axes& wanted, const Axes& reached) {
  const LaneTriple twice =
      cross(wanted.n, reached.n) + cross(wanted.o, reached.o) + cross(wanted.a, reached.a);
  return {0.5 * twice.x, 0.5 * twice.y, 0.5 * twice.z};
}

}  // namespace
}  // namespace armature
