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

/// Four branches, each at an arm angle of its own.
struct FourPlaces {
  double arm_angle[4];
  int branch[4];  // index into kBranches
};
struct FourBranches {
  double joint[7][4];                  // the robot's values, in [-pi, pi)
  double position_m[4], angle_rad[4];  // by which forward kinematics miss the goal
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
  static constexpr int kMost = 704, kWords = kMost / 64;
  /// [rad] The first `sorted` rise from -pi to pi, of which `regular` and the last are in equal
  /// steps; behind them are those of narrow spans. `count` is a multiple of eight.
  double place[kMost];
  int regular = 0, sorted = 0, count = 0;
  float value[8][kMost + 8], slope[8][kMost + 8];  // by branch
  /// A bit for every place: between it and the next there is a minimum.
  std::uint64_t valley[8][kWords];
};

/// Places of four branches and what they cost; two of each with a minimum between them, or beyond
/// them but not beyond `lower` and `upper`; and that.
struct FourNodes {
  double at[4], value[4], slope[4];
};
struct Valleys {
  int branch[4];
  FourNodes left, right;
  double lower[4], upper[4];
};
struct Minima {
  double at[4], value[4];
};

/// What an arm angle costs; `last`: the one that is remembered, if any.
struct Aim {
  Objective objective = Objective::limits;
  bool remembers = false;
  double last = 0;
};

/// Lanes are shoulders and wrists of both elbows, places, or branches: four at once. The same
/// source is compiled for each kind of processor. Real-time safe.
struct SrsKernel {
  /// Of four sines and cosines, and back.
  void (*angles)(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]);
  void (*sines)(const double (&angle)[4], double (&sine)[4], double (&cosine)[4]);
  /// All branches at one arm angle, in the order of kBranches.
  void (*turn_to)(const ArmNumbers& arm, const SrsGoal& goal, double arm_angle,
                  FourBranches (&out)[2]);
  void (*turn_each)(const ArmNumbers& arm, const SrsGoal& goal, const FourPlaces& at,
                    FourBranches& out);
  void (*limit_pieces)(const ArmNumbers& arm, const SrsGoal& goal, LimitPieces& out);
  void (*cost_all_round)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                         CostTable& table);
  void (*cost_at)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, const FourPlaces& at,
                  double (&value)[4], double (&slope)[4]);
  void (*find_minima)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                      const Valleys* valleys, int count, Minima* minima);
};
const SrsKernel& portable_srs_kernel();
const SrsKernel& avx2_srs_kernel();
/// Those that this processor can run, the fastest last.
struct SrsKernels {
  const SrsKernel* kernel[2];
  int count;
};
SrsKernels srs_kernels();
const SrsKernel& srs_kernel();  // the fastest

}  // namespace armature
