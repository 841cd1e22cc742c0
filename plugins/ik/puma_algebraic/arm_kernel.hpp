// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// Plain numbers only: what is compiled for one kind of processor must not share inline functions
// with the rest.
namespace armature {

struct Triple {
  double x = 0, y = 0, z = 0;
};

/// An arm of the PUMA pattern (see PumaArm), the limits of its joints, and where it stands.
struct ArmNumbers {
  double a1 = 0, d2 = 0, a2 = 0, forearm = 0;            // [m]
  double beta = 0, cos_beta = 1, sin_beta = 0;           // between forearm and x of link 3
  double sign[6]{1, 1, 1, 1, 1, 1}, zero[6]{};           // q = sign t - zero, within [-pi, pi)
  double middle[6]{}, half[6]{};                         // of the range of each joint
  bool needle = false;                                   // joint 6 slides
  double shoulder_R_base[3][3]{}, base_t_shoulder[3]{};  // matrices by rows; [m]
  double tool_R_wrist[3][3]{}, wrist_t_tool[3]{};
};

/// A wrist out of reach by less than `slack` [m] is on the rim of reach; axes 4 and 6 nearer to in
/// line than `in_line` [rad] are in line.
struct Rims {
  double slack = 0, in_line = 0;
};

/// What is asked, seen from the shoulder frame. `n`, `o`, `a`: the wrist's axes.
struct ArmQuestion {
  enum class Task {
    rotation,   // n, o, a: joint 6 turns
    pointing,   // a alone; joint 6 is at `sixth`
    fixed_roll  // n, o, a with t6 = 0: only right where the roll error is 0
  };
  Task task = Task::rotation;
  Triple wrist;  // [m]
  Triple n, o, a;
  Triple lever;             // from wrist to tool [m]
  double sixth = 0;         // value of joint 6 that the task leaves open, [rad] or [m]
  double wrist_factor = 0;  // of fixed_roll: what takes the place of sin(t5) in det J
  Rims rims;
  struct Kept {
    double t1 = 0, t2 = 0, t4 = 0;
  } kept;  // [rad] where the pose leaves them free
};

/// The answer for shoulder 0 elbow 0, shoulder 0 elbow 1, shoulder 1 elbow 0, shoulder 1 elbow 1.
/// Where no arm is reached all else is undefined.
struct FourArms {
  bool reached[4], singular[4];
  bool free1, free2[4];   // joint 1 of all or joint 2 of an arm was left free, and kept
  double joint[2][6][4];  // of wrist 0 and wrist 1: the robot's values, angles in [-pi, pi)
  double margin[2][4];    // of the joint that is nearest to a limit; negative beyond [rad or m]
  double position_m[4], angle_rad[4];  // by which forward kinematics miss the goal
};

/// Of a rotation, for the same arms: sine of the angle by which the axis of joint 5 at t6 = 0
/// misses being square to the forearm; where the arm does not reach, to that of the arm that comes
/// nearest.
struct RollErrors {
  double of[4];
  bool reached[4];
};

/// Poses of the tool, as in IkBatch.
struct PoseBatch {
  std::size_t count;
  const double* position[3];
  const double* rotation[4];
  Rims rims;
};

/// The answers in slots, arm by arm as of FourArms, and wrist by wrist; as in IkBatchAnswers.
struct PoseAnswers {
  /// What `found` is of a pose that leaves a joint free, that is bad, or of less poses than the
  /// processor has lanes: all else of the answer is undefined.
  static constexpr std::uint16_t kSpecial = 0xFFFF;

  double* joint[8][6];
  std::uint16_t *found, *within_limits, *singular;  // a bit for each slot
  double *position_m, *angle_rad;
};

/// The same source compiled for each kind of processor. Real-time safe.
struct ArmKernel {
  void (*solve)(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out);
  void (*roll_errors)(const ArmNumbers& arm, const ArmQuestion& question, RollErrors& out);
  /// Rotations, by an arm whose joints all turn.
  void (*solve_poses)(const ArmNumbers& arm, const PoseBatch& poses, const PoseAnswers& out);
};
/// Those that this processor can run, the fastest last.
struct ArmKernels {
  ArmKernel kernel[3];
  int count;
};
ArmKernels arm_kernels();
namespace portable {
ArmKernel arm_kernel();
}
namespace avx2 {
ArmKernel arm_kernel();
}
namespace avx512 {
ArmKernel arm_kernel();
}

}  // namespace armature
