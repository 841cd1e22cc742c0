// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numbers>
#include <string_view>

// Plain numbers only: what is compiled for one kind of processor must not share inline functions
// with the rest.
namespace armature::ik::srs_arm_angle {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kLimitTolerance = 1e-9;  // [rad] that of the kind

/// Sine and cosine of an angle.
struct SinCos {
  double sin = 0, cos = 1;
};

/// Joints of an arm of SrsArm's form: t = sign q + offset; limits of t: middle +- half, which may
/// be infinite [rad].
struct ArmNumbers {
  double upper = 0, fore = 0;  // [m] shoulder to elbow, elbow to wrist
  double sign[7]{1, 1, 1, 1, 1, 1, 1}, offset[7]{};
  double middle[7]{}, half[7]{};
  double weight[7]{};  // 1 / half; 0 where the limits cost nothing
  /// The middle, and the half with the tolerance that intervals have; half a turn without limits.
  SinCos middle_turn[7], half_turn[7];
  /// Lower and upper limits of joints 1 and 5, of 2 and 6, of 3 and 7; NaN without limits.
  double end_sin[3][4]{}, end_cos[3][4]{};
};

/// The shoulder (joints 1 to 3) or the wrist (5 to 7) at the arm angle psi, as a spherical triangle
/// of the sides p, q and b:
///
///   Rz(a) Ry(b) Rz(c) = Ry(p) Rz(x) Ry(q),  x = start + direction psi
///
/// The joints are a + shift_a, b, c + shift_c; the other solution is a + pi, -b, c + pi.
struct Triangle {
  SinCos p, q, start;
  double start_rad = 0, direction = 1;
  double shift_a_rad = 0, shift_c_rad = 0;
  SinCos shift_a, shift_c;
  double sine_at_0 = 0, sine_at_pi = 0;  // sin b at x = 0 and at x = pi
  /// The axes of a and c are collinear (sin b = 0) at some psi. Only a + c or a - c is determined
  /// there, and a is kept.
  bool collinear = false;
  SinCos kept_a;
};

/// A goal in SrsArm's form, and what of the arm does not depend on the arm angle.
struct SrsGoal {
  double rotation[3][3];                  // columns of shoulder_R_wrist
  double shoulder_to_wrist[3], lever[3];  // [m]; wrist to tool
  double distance = 0;                    // [m] shoulder to wrist
  double t4 = 0;                          // [rad] of elbow 0; elbow 1 has -t4
  SinCos elbow;                           // of t4
  Triangle shoulder, wrist;               // of elbow 0
  double collinear = 0;                   // [rad] axes at a smaller angle are collinear
  /// How far the wrist is out of reach [m], and why.
  double shortfall = 0;
  std::string_view detail;
};

/// Branch 4 s + 2 e + w is shoulder s, elbow e, wrist w. Elbow 1 at psi stands where elbow 0 does
/// at psi - pi, with t3 and t5 half a turn on and t4 negated.
inline constexpr std::string_view kLabels[8]{"shoulder0/elbow0/wrist0", "shoulder0/elbow0/wrist1",
                                             "shoulder0/elbow1/wrist0", "shoulder0/elbow1/wrist1",
                                             "shoulder1/elbow0/wrist0", "shoulder1/elbow0/wrist1",
                                             "shoulder1/elbow1/wrist0", "shoulder1/elbow1/wrist1"};
inline constexpr unsigned kOfElbow1 = 0b11001100;

/// Eight branches, any of them, each at an arm angle of its own.
struct EightPlaces {
  double arm_angle[8];
  int branch[8];
};
/// A bit of each mask for each place.
struct EightBranches {
  double joint[7][8];                  // the robot's values, in [-pi, pi)
  double position_m[8], angle_rad[8];  // by which forward kinematics miss the goal
  unsigned within_limits, singular;
  unsigned collinear_shoulder, collinear_wrist;  // turns are not shared out yet (share_turns)
};

/// What the arm angle shall make small.
enum class Objective {
  /// Sum of u^2 / (1 - u^2), u the distance of a joint from the middle of its range over half of
  /// it; joints that turn all the way count nothing.
  limits,
  /// -sin^2 t2 sin^2 t6 norm(dt/dpsi)^2
  singularity,
  /// The distance from the last arm angle, or the seed's: no search.
  continuity,
  /// limits + 0.02 sum 1 / (sin^2 b + 1e-3) + 0.1 (distance from the last arm angle)^2, b of
  /// shoulder and wrist
  balanced
};
/// `last`: the arm angle that is remembered, if any.
struct Aim {
  Objective objective = Objective::limits;
  bool remembers = false;
  double last = 0;
};

/// Costs of all branches at arm angles of elbow 0 that rise from -pi to pi.
struct CostTable {
  static constexpr int kMaxRegular = 48, kMaxMore = 168;
  static constexpr int kMax = kMaxRegular + kMaxMore + 8, kWords = (kMax + 63) / 64;
  double place[kMax];  // [rad]; behind the `count` used ones there is room for what fills lanes
  int regular = 0, count = 0;
  int of_regular[kMaxRegular + 1];        // where a regular place stands
  double value[8][kMax], slope[8][kMax];  // by branch
  /// Bit i: between places i and i + 1 there is a minimum.
  std::uint64_t valley[8][kWords];
};

/// A branch at an arm angle [rad], its cost and the cost's derivative.
struct Node {
  int branch;
  double at, value, slope;
};
/// Two nodes of one branch with a minimum between them.
struct Valley {
  Node left, right;
};

/// The arithmetic, by four lanes, compiled for each kind of processor. Real-time safe.
struct Kernel {
  /// Of four sines and cosines, and back.
  void (*angles)(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]);
  void (*sines)(const double (&angle)[4], double (&sine)[4], double (&cosine)[4]);
  /// All branches at one arm angle.
  void (*solve)(const ArmNumbers& arm, const SrsGoal& goal, double arm_angle, EightBranches& out);
  void (*solve_each)(const ArmNumbers& arm, const SrsGoal& goal, const EightPlaces& at,
                     EightBranches& out);
  /// Arm angles of elbow 0 at which joints reach their limits; NaN where they do not.
  void (*limit_angles)(const ArmNumbers& arm, const SrsGoal& goal, double (&at)[24]);
  /// At which of up to 64 arm angles of elbow 0, a bit for each, a branch keeps the limits of all
  /// joints but joint 4. The angles that fill lanes are asked, too.
  void (*keep_limits)(const ArmNumbers& arm, const SrsGoal& goal, const double* at, int count,
                      std::uint64_t (&kept)[8]);
  void (*costs_all_round)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                          CostTable& table);
  void (*costs)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, int count, Node* nodes);
  /// The minimum of each valley; its slope is not told.
  void (*minima)(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, int count,
                 const Valley* valleys, Node* minima);
};
const Kernel& portable_kernel();
const Kernel& avx2_kernel();
/// Whether this processor runs avx2_kernel.
bool has_avx2();
/// The fastest that this processor runs.
const Kernel& kernel();

}  // namespace armature::ik::srs_arm_angle
