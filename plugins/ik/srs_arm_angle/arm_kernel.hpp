// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "arm_posture.hpp"
#include "objective.hpp"
#include "srs_goal.hpp"
#include "srs_structure.hpp"

namespace armature {

/// What the kernel needs of joints 1 and 5, of 2 and 6, or of 3 and 7: first the shoulder's joint,
/// twice, then the wrist's.
struct TurnNumbers {
  double sign[4], offset[4], middle[4], half[4];  // as in SrsArm
  double weight[4];                               // 1 / half; 0 where the limits cost nothing
  double middle_sin[4], middle_cos[4];
  double half_sin[4],
      half_cos[4];  // of half with its tolerance; 0 and -1 of a joint without limits
  // Of the lower and the upper limit, shoulder and then wrist; NaN of a joint without limits.
  double end_sin[4], end_cos[4];
};
struct ArmNumbers {
  SrsArm arm;
  TurnNumbers turn[3];
};
ArmNumbers numbers_of(const SrsArm& arm);

/// Eight branches at once, any of them, each at an arm angle of its own.
struct EightPlaces {
  double arm_angle[8];
  int branch[8];  // index into kBranches
};
struct EightBranches {
  double joint[7][8];                  // the robot's values, in [-pi, pi)
  double position_m[8], angle_rad[8];  // by which forward kinematics miss the goal
  // A bit for each branch. Where shoulder or wrist is in line the joints are not told: solve_elbow
  // has the rules.
  unsigned within_limits, singular, in_line;
};

/// Where shoulder and wrist keep their limits, of either elbow, as found and flipped: in arm angles
/// of elbow 0 from -pi to pi, between two of which nothing changes; those of elbow 1 are half a
/// turn further.
struct LimitPieces {
  static constexpr int kEvents = 16;
  double event[2][kEvents];  // of shoulder and wrist; rising, the last ones may be equal
  /// By ball, elbow and flip. Bit 2 i: the limits are kept at event i; bit 2 i + 1: between it and
  /// the next.
  std::uint32_t kept[2][2][2];
};

/// Costs all round, in single precision: places are arm angles of elbow 0.
struct CostTable {
  static constexpr int kMaxRegular = 48, kMaxMore = 168, kMaxNarrow = 480;
  static constexpr int kMax = 704, kWords = kMax / 64;
  static_assert(kMaxRegular + kMaxMore + 1 + kMaxNarrow <= kMax);
  static constexpr int kMargin = 16;  // a place has a neighbour, which may be anything
  /// [rad] The first `sorted` rise from -pi to pi, of which `regular` and the last are in equal
  /// steps; behind them are those of narrow spans.
  double place[kMax];
  int regular = 0, sorted = 0, count = 0;
  float value[8][kMax + kMargin], slope[8][kMax + kMargin];  // by branch
  /// A bit for every place: between it and the next there is a minimum.
  std::uint64_t valley[8][kWords];
};

/// Places of eight branches, any of them, and what they cost.
struct EightNodes {
  double at[8], value[8], slope[8];
};
/// Nodes with a minimum between them, or a little beyond them, but not beyond `lower` and `upper`;
/// `outer` is one more on either side, with an `at` that is not a number where there is none.
struct EightValleys {
  int branch[8];
  EightNodes left, right, outer;
  double lower[8], upper[8];
};
/// The minima of valleys, and what they cost.
struct EightMinima {
  double at[8], value[8];
};

/// What an arm angle costs; `last`: the one that is remembered, if any.
struct Aim {
  Objective objective = Objective::limits;
  bool remembers = false;
  double last = 0;
};

/// Lanes are shoulders and wrists of both elbows, places, or branches. The same source is compiled
/// for each kind of processor. Real-time safe.
struct SrsKernel {
  /// Of four sines and cosines, and back.
  void (*angles)(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]);
  void (*sines)(const double (&angle)[4], double (&sine)[4], double (&cosine)[4]);
  /// All branches at one arm angle, in the order of kBranches.
  void (*turn_to)(const ArmNumbers& arm, const SrsGoal& goal, double arm_angle, EightBranches& out);
  void (*turn_each)(const ArmNumbers& arm, const SrsGoal& goal, const EightPlaces& at,
                    EightBranches& out);
  /// First the events, then between which of them limits are kept.
  void (*limit_events)(const ArmNumbers& arm, const SrsGoal& goal, LimitPieces& out);
  void (*limits_kept)(const ArmNumbers& arm, const SrsGoal& goal, LimitPieces& out);
  void (*cost_all_round)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                         CostTable& table);
  /// Of the first `count` and perhaps more.
  void (*cost_at)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, const EightPlaces& at,
                  int count, double (&value)[8], double (&slope)[8]);
  void (*find_minima)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                      const EightValleys& valleys, int count, EightMinima& minima);
};
const SrsKernel& portable_srs_kernel();
const SrsKernel& avx2_srs_kernel();
const SrsKernel& avx512_srs_kernel();
/// Those that this processor can run, the fastest last.
struct SrsKernels {
  const SrsKernel* kernel[3];
  int count;
};
SrsKernels srs_kernels();
const SrsKernel& srs_kernel();  // the fastest

}  // namespace armature
