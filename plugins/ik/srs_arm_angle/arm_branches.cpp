// SPDX-License-Identifier: Apache-2.0
#include "arm_branches.hpp"

#include <cmath>
#include <limits>

namespace armature::ik::srs_arm_angle {
namespace {

/// How far joint `first` has to go, joint `first` + 2 going `ratio` times as far, for both to keep
/// their limits; 0 when no way does it. One of them ends at a limit.
double way_to_limits(const SrsArm& arm, std::size_t first, double t, double u, double ratio) {
  constexpr double kAtLimit = 1e-12;
  const std::size_t last = first + 2;
  double best = std::numeric_limits<double>::infinity();
  for (const double end : {-1.0, 1.0}) {
    for (const double way : {wrap_angle(arm.middle[first] + end * arm.half[first] - t),
                             ratio * wrap_angle(arm.middle[last] + end * arm.half[last] - u)}) {
      const bool inside =
          arm.beyond(first, t + way) <= kAtLimit && arm.keeps_limits(last, u + ratio * way);
      if (inside && std::abs(way) < std::abs(best)) best = way;
    }
  }
  return std::isfinite(best) ? best : 0;
}

/// Of joints `first`, `first` + 1 and `first` + 2 of branch `i`, whose axes are collinear.
void share_turns(const SrsArm& arm, std::size_t first, std::size_t i, EightBranches& out) {
  double t[3];
  bool within = true;
  for (std::size_t k = 0; k < 3; ++k) {
    t[k] = arm.canonical(first + k, out.joint[first + k][i]);
    within = within && arm.keeps_limits(first + k, t[k]);
  }
  if (within) return;
  const double ratio = std::abs(t[1]) < kPi / 2 ? -1 : 1;  // c goes against a, or with it
  const double way = way_to_limits(arm, first, t[0], t[2], ratio);
  out.joint[first][i] = arm.joint(first, t[0] + way);
  out.joint[first + 2][i] = arm.joint(first + 2, t[2] + ratio * way);
}

void share_all_turns(const SrsArm& arm, EightBranches& out) {
  for (std::size_t i = 0; i < 8; ++i) {
    const unsigned bit = 1U << i;
    if (((out.collinear_shoulder | out.collinear_wrist) & ~out.within_limits & bit) == 0) continue;
    if (out.collinear_shoulder & bit) share_turns(arm, 0, i, out);
    if (out.collinear_wrist & bit) share_turns(arm, 4, i, out);
    bool within = true;
    for (std::size_t k = 0; k < 7; ++k) {
      within = within && arm.keeps_limits(k, arm.canonical(k, out.joint[k][i]));
    }
    if (within) out.within_limits |= bit;
  }
}

}  // namespace

void solve(const SrsArm& arm, const SrsGoal& goal, double arm_angle, EightBranches& out) {
  kernel().solve(arm, goal, arm_angle, out);
  share_all_turns(arm, out);
}
void solve_each(const SrsArm& arm, const SrsGoal& goal, const EightPlaces& at, EightBranches& out) {
  kernel().solve_each(arm, goal, at, out);
  share_all_turns(arm, out);
}

bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}
const Kernel& kernel() {
#if defined(__x86_64__)
  static const bool avx2 = has_avx2();
  if (avx2) return avx2_kernel();
#endif
  return portable_kernel();
}

}  // namespace armature::ik::srs_arm_angle
