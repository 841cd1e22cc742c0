// SPDX-License-Identifier: Apache-2.0
#include "srs_kernel.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace armature {
namespace {

// Less than half of the kind's, so that between two roots that rounding took apart, where the
// middle is asked, both ends are within limits there [rad].
constexpr double kNearTolerance = 0.45e-9;

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
  const double end = wide < std::numbers::pi ? arm.middle[i] + (lane % 2 == 0 ? -half : half)
                                             : std::numeric_limits<double>::quiet_NaN();
  numbers.end_sin[lane] = std::sin(end);
  numbers.end_cos[lane] = std::cos(end);
}

}  // namespace

ArmNumbers numbers_of(const SrsArm& arm) {
  ArmNumbers numbers{.arm = arm, .turn = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      set_joint(arm, lane < 2 ? i : i + 4, lane, numbers.turn[i]);
    }
  }
  return numbers;
}

const SrsKernel& srs_kernel() {
#if defined(__x86_64__)
  static const bool fast = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (fast) return avx2::srs_kernel();
#endif
  return portable::srs_kernel();
}

}  // namespace armature
