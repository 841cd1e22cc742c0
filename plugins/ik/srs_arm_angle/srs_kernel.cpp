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

constexpr double kTolerance = 1e-9;  // [rad] that of the kind

bool has(unsigned bits, std::size_t i) { return (bits >> i & 1) != 0; }

double beyond(const SrsArm& arm, std::size_t i, double t) {
  return std::abs(wrap_angle(t - arm.middle[i])) - arm.half[i];
}

/// How far the first joint has to go, the last one going `ratio` times as far, for both to keep
/// their limits; 0 when no way does it. One of them ends at a limit.
double way_to_limits(const SrsArm& arm, std::size_t first, double t, double u, double ratio) {
  constexpr double kAtLimit = 1e-12;
  double best = std::numeric_limits<double>::infinity();
  for (const double end : {-1.0, 1.0}) {
    for (const double way :
         {wrap_angle(arm.middle[first] + end * arm.half[first] - t),
          ratio * wrap_angle(arm.middle[first + 2] + end * arm.half[first + 2] - u)}) {
      const bool inside = beyond(arm, first, t + way) <= kAtLimit &&
                          beyond(arm, first + 2, u + ratio * way) <= kTolerance;
      if (inside && std::abs(way) < std::abs(best)) best = way;
    }
  }
  return std::isfinite(best) ? best : 0;
}

/// Of a lane that is in line.
void share_out_turns(const SrsArm& arm, std::size_t lane, TwoArms& arms) {
  const std::size_t first = lane < 2 ? 0 : 4;
  double t[3];
  for (std::size_t i = 0; i < 3; ++i) t[i] = arm.canonical(first + i, arms.joint[0][i][lane]);
  // The last joint goes against the first, or with it.
  const double ratio = std::abs(t[1]) < std::numbers::pi / 2 ? -1 : 1;
  const double way = way_to_limits(arm, first, t[0], t[2], ratio);
  if (way == 0) return;
  for (std::size_t flip = 0; flip < 2; ++flip) {
    arms.joint[flip][0][lane] = arm.joint(first, t[0] + way);
    arms.joint[flip][2][lane] = arm.joint(first + 2, t[2] + ratio * way);
    if (within_limits(arm, first + 1, t[1])) arms.within_limits[flip] |= 1U << lane;
  }
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

bool within_limits(const SrsArm& arm, std::size_t i, double t) {
  return beyond(arm, i, t) <= kTolerance;
}

TwoArms arms_at(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                const TwoPlaces& at) {
  TwoArms arms;
  kernel.turn(numbers, goal, at, arms);
  const unsigned to_share = arms.in_line & ~arms.within_limits[0];
  for (std::size_t lane = 0; lane < 4 && to_share != 0; ++lane) {
    if (has(to_share, lane)) share_out_turns(numbers.arm, lane, arms);
  }
  return arms;
}

void set_branch(const TwoArms& arms, std::size_t arm, const Branch& which, double arm_angle,
                IkBranch& out) {
  const auto& [shoulder, wrist] = which.flips;
  out.label = which.label;
  out.q.resize(7);
  for (std::size_t i = 0; i < 3; ++i) {
    out.q.data()[i] = arms.joint[shoulder][i][arm];
    out.q.data()[i + 4] = arms.joint[wrist][i][arm + 2];
  }
  out.q.data()[3] = arms.fourth[arm];
  out.redundancy = arm_angle;
  out.residual = {arms.position_m[arm], arms.angle_rad[arm]};
  out.within_limits = has(arms.within_limits[shoulder], arm) &&
                      has(arms.within_limits[wrist], arm + 2) &&
                      has(arms.fourth_within_limits, arm);
  out.singular = has(arms.singular, arm);
}

}  // namespace armature
