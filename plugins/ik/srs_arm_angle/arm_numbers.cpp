// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include "arm_kernel.hpp"

namespace armature {
namespace {

// Less than the kind's, so that what is feasible here is within limits there [rad].
constexpr double kNearTolerance = 0.9e-9;

void set_joint(const SrsArm& arm, std::size_t i, std::size_t lane, TurnNumbers& numbers) {
  constexpr double kLocked = 1e-9;
  const double half = arm.half[i], wide = half + kNearTolerance;
  numbers.sign[lane] = arm.sign[i];
  numbers.offset[lane] = arm.offset[i];
  numbers.middle[lane] = arm.middle[i];
  numbers.half[lane] = half;
  numbers.weight[lane] = half >= std::numbers::pi || half < kLocked ? 0 : 1 / half;
  numbers.middle_sin[lane] = std::sin(arm.middle[i]);
  numbers.middle_cos[lane] = std::cos(arm.middle[i]);
  numbers.half_sin[lane] = wide < std::numbers::pi ? std::sin(wide) : 0;
  numbers.half_cos[lane] = wide < std::numbers::pi ? std::cos(wide) : -1;
}

void set_end(const SrsArm& arm, std::size_t i, double side, std::size_t lane,
             TurnNumbers& numbers) {
  const bool open = arm.half[i] + kNearTolerance >= std::numbers::pi;
  const double end =
      open ? std::numeric_limits<double>::quiet_NaN() : arm.middle[i] + side * arm.half[i];
  numbers.end_sin[lane] = std::sin(end);
  numbers.end_cos[lane] = std::cos(end);
}

}  // namespace

ArmNumbers numbers_of(const SrsArm& arm) {
  ArmNumbers numbers{.arm = arm, .turn = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::size_t joint = lane < 2 ? i : i + 4;
      set_joint(arm, joint, lane, numbers.turn[i]);
      set_end(arm, joint, lane % 2 == 0 ? -1 : 1, lane, numbers.turn[i]);
    }
  }
  return numbers;
}

}  // namespace armature
