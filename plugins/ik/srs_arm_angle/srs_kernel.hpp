// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "ik_srs_arm_angle_parameters.hpp"
#include "srs_goal.hpp"

namespace armature {

/// Which shoulder and which wrist: as found (0) or flipped (1).
struct Flips {
  std::size_t shoulder = 0, wrist = 0;
};
/// One of the eight, in the order in which they are answered. Shoulder 0: sin t2 >= 0; elbow 0:
/// t4 >= 0; wrist 0: sin t6 >= 0, of SrsArm's angles.
struct Branch {
  std::string_view label;
  std::size_t elbow;
  Flips flips;
};
inline constexpr std::array<Branch, 8> kBranches{{{"shoulder0/elbow0/wrist0", 0, {0, 0}},
                                                  {"shoulder0/elbow0/wrist1", 0, {0, 1}},
                                                  {"shoulder0/elbow1/wrist0", 1, {0, 0}},
                                                  {"shoulder0/elbow1/wrist1", 1, {0, 1}},
                                                  {"shoulder1/elbow0/wrist0", 0, {1, 0}},
                                                  {"shoulder1/elbow0/wrist1", 0, {1, 1}},
                                                  {"shoulder1/elbow1/wrist0", 1, {1, 0}},
                                                  {"shoulder1/elbow1/wrist1", 1, {1, 1}}}};
/// An arm of elbow 1 at an arm angle stands where that of elbow 0 does, less this [rad].
inline double half_turns(std::size_t elbow) { return elbow == 0 ? 0 : std::numbers::pi; }

/// What the kernel needs of joints 1 and 5, of 2 and 6, or of 3 and 7: first the shoulder's joint,
/// twice, then the wrist's.
struct TurnNumbers {
  double sign[4], offset[4], middle[4], half[4];  // as in SrsArm
  double weight[4];                               // 1 / half; 0 where the limits cost nothing
  double middle_sin[4], middle_cos[4];
  // Of half with its tolerance; 0 and -1 of a joint without limits.
  double half_sin[4], half_cos[4];
  // Of the lower and the upper limit, shoulder and then wrist; NaN of a joint without limits.
  double end_sin[4], end_cos[4];
};
struct ArmNumbers {
  SrsArm arm;
  TurnNumbers turn[3];
};
ArmNumbers numbers_of(const SrsArm& arm);

/// Two arms, each of an elbow (0 or 1) and at an arm angle [rad].
struct TwoPlaces {
  double arm_angle[2];
  int elbow[2];
};
/// Lanes: the shoulders of both arms, then their wrists. A bit for each lane, or for each arm.
struct TwoArms {
  double joint[2][3][4];      // by flip: the robot's values, in [-pi, pi)
  double fourth[4];           // of the first two lanes: joint 4
  unsigned within_limits[2];  // by flip; of the lanes
  unsigned fourth_within_limits;
  /// Only a sum or difference of the outer joints is determined: both flips are one, and the first
  /// joint is the one that is kept.
  unsigned in_line;
  double position_m[4], angle_rad[4];  // of the first two lanes: residual of forward kinematics
  unsigned singular;
};

/// Where limits are kept, by ball (0: shoulder, 1: wrist), elbow and flip. Bit 2 i: at the `i`th of
/// some rising arm angles of elbow 0; bit 2 i + 1: between it and the next.
struct KeptLimits {
  static constexpr int kMax = 32;  // arm angles
  std::uint64_t bits[2][2][2] = {};
};

/// What the arm angle shall make small:
/// limits:      sum of u^2 / (1 - u^2), u the distance of a joint from the middle of its range over
///              half of it; joints that turn all the way count nothing
/// singularity: the square of sin(t2) sin(t6) norm(t'), negated; t' is how fast the joints turn
///              with the arm angle
/// continuity:  the distance from the wanted arm angle: costs tell nothing
/// balanced:    limits + 0.02 sum 1 / (sin(b)^2 + 1e-3) + 0.1 (distance from the last arm angle)^2,
///              b of shoulder and wrist
using Objective = ik::srs_arm_angle::Parameters::Objective;
/// What is to be small, and the arm angle that is remembered, if any.
struct Aim {
  Objective objective = Objective::limits;
  bool remembers = false;
  double last = 0;
};

/// An arm angle of elbow 0 [rad], what it costs, and how that changes.
struct Node {
  double at, value, slope;
};
/// What branches cost at places all round.
struct CostTable {
  static constexpr int kMax = 256, kMargin = 8;  // a place has neighbours, which may be anything

  double place[kMax];  // rising arm angles of elbow 0 [rad]
  int count = 0;
  double value[8][kMax + kMargin], slope[8][kMax + kMargin];  // by branch
  /// A bit for every place: between it and the next there is a minimum.
  std::uint64_t valley[8][kMax / 64];

  Node node(std::size_t branch, int at) const {
    return {place[at], value[branch][at], slope[branch][at]};
  }
};

/// Between two nodes of a branch (of kBranches) there is a minimum.
struct Valley {
  std::size_t branch;
  Node left, right;
};

/// The same source compiled for each kind of processor. Real-time safe.
struct SrsKernel {
  /// Of four sines and cosines.
  void (*angles)(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]);
  void (*turn)(const ArmNumbers& arm, const SrsGoal& goal, const TwoPlaces& at, TwoArms& out);
  /// Arm angles of elbow 0, within [-pi, pi], where a shoulder and a wrist are at a limit or their
  /// outer joints may jump; NaN where there are less.
  void (*limit_roots)(const ArmNumbers& arm, const SrsGoal& goal, double (&root)[2][14]);
  /// Sets bit 2 i + `first` where the limits are kept at `at[i]`, of an even count.
  void (*limits_kept)(const ArmNumbers& arm, const SrsGoal& goal, const double* at, int count,
                      int first, KeptLimits& kept);
  void (*costs_all_round)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                          CostTable& table);
  /// Of each valley a place where the costs are least, to 1e-8 rad, and what that costs.
  void (*minima)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, const Valley* valleys,
                 int count, Node* minima);
};
namespace portable {
const SrsKernel& srs_kernel();
}
namespace avx2 {
const SrsKernel& srs_kernel();
}
/// The fastest that this processor can run.
const SrsKernel& srs_kernel();

/// Joint `i` (from 0) at the canonical angle `t` keeps its limits (to within the kind's 1e-9 rad).
bool within_limits(const SrsArm& arm, std::size_t i, double t);

/// Two arms; where a shoulder or wrist is in line its outer turns are shared out so that the limits
/// are kept if they can be, the first as near to what is kept as that allows.
TwoArms arms_at(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                const TwoPlaces& at);

/// A branch out of arm 0 or 1, which has its elbow; `arm_angle` in [-pi, pi).
void set_branch(const TwoArms& arms, std::size_t arm, const Branch& which, double arm_angle,
                IkBranch& out);

}  // namespace armature
