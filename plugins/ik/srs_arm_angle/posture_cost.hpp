// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "arm_posture.hpp"
#include "feasible_angles.hpp"

namespace armature {

/// A number that depends on the arm angle, and its slope.
struct Level {
  double value, slope;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Level operator*(double factor, const Level& a) {
    return {factor * a.value, factor * a.slope};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
};

/// What the arm angle shall make small.
enum class Objective {
  limits,       // the sum of BallCost::limits
  singularity,  // the negative square of spread_of
  continuity,   // the distance from the wanted arm angle: `nearest_in` alone decides
  balanced      // limits + 0.02 sum 1 / (sine2 + 1e-3) + 0.1 (distance from the last arm angle)^2
};
/// "limits", ...; `name` is one of them.
Objective objective_from(std::string_view name);

/// What a shoulder or wrist adds to the cost of an arm angle, as far as the objective asks for it.
struct BallCost {
  /// Sum of u^2 / (1 - u^2), u the distance of a joint from the middle of its range over half of
  /// it, as found and flipped; joints that turn all the way count nothing.
  std::array<Level, 2> limits;
  Level sine2;   // sin(b)^2, which is 0 where a and c turn about one axis
  Level rates2;  // square of sin(b) (a', b', c')
};
BallCost cost_of(const SrsArm& arm, const ArmBall& ball, Objective objective, double arm_angle);

/// Shoulder and wrist at one arm angle.
struct PostureCost {
  BallCost shoulder, wrist;

  /// `from_last`: arm angle less the last one [rad], 0 where none is remembered.
  Level of(Objective objective, const Flips& flips, double from_last) const;
};
inline PostureCost cost_of(const SrsArm& arm, const ArmCircle& circle, Objective objective,
                           double arm_angle) {
  return {cost_of(arm, circle.shoulder, objective, arm_angle),
          cost_of(arm, circle.wrist, objective, arm_angle)};
}

}  // namespace armature
