// SPDX-License-Identifier: Apache-2.0
#pragma once

// Plain numbers only: what is compiled for one kind of processor must not share inline functions
// with the rest.
namespace armature {

struct Triple {
  double x = 0, y = 0, z = 0;
};

/// An arm (PumaArm) and the limits of its joints, as the kernel uses them.
struct ArmNumbers {
  double a1, d2, a2, forearm;       // [m]
  double beta, cos_beta, sin_beta;  // atan2(d4, a3)
  double sign[6], zero[6];          // q = sign t - zero
  double middle[6], half[6];        // of the range of each joint
  bool needle;                      // joint 6 slides
};

/// What is asked, seen from the shoulder frame. `n`, `o`, `a`: the wrist's axes.
struct ArmQuestion {
  enum class Task {
    rotation,   // n, o, a: joint 6 turns
    pointing,   // a alone; joint 6 is at `sixth`
    fixed_roll  // n, o, a with t6 = 0: only right where roll_errors are 0
  };
  Task task = Task::rotation;
  Triple wrist;  // [m]
  Triple n, o, a;
  Triple lever;                   // from wrist to tool [m]
  double sixth = 0;               // value of joint 6 that the task leaves open, [rad] or [m]
  double wrist_factor = 0;        // of fixed_roll: what takes the place of sin(t5) in det J
  double slack = 0;               // [m] a wrist out of reach by less is on the rim of reach
  double in_line = 0;             // [rad] axes 4 and 6 nearer to in line are in line
  double t1 = 0, t2 = 0, t4 = 0;  // [rad] kept where the pose leaves them free
};

/// The answer for shoulder 0 elbow 0, shoulder 0 elbow 1, shoulder 1 elbow 0, shoulder 1 elbow 1.
struct FourArms {
  bool reached[4];
  bool singular[4];
  // What the pose left free and the question decided: joint 1 of all, joint 2 or joint 4 of an arm.
  bool kept1, kept2[4], kept4[4];
  double joint[2][6][4];  // of wrist 0 and wrist 1: the robot's values, angles in [-pi, pi)
  double margin[2][4];    // of the joint that is nearest to a limit; negative beyond [rad or m]
  double position_m[4], angle_rad[4];  // by which forward kinematics miss the goal
  double shortfall;                    // [m] when no arm reaches
  const char* detail;
};

/// The same source compiled twice. Real-time safe.
struct ArmKernel {
  void (*solve)(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out);
  /// Of a rotation: sine of the angle by which the axis of joint 5 at t6 = 0 misses being square to
  /// the forearm. NaN where the arm does not reach; then `shortfall` and `detail` say why.
  void (*roll_errors)(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out,
                      double (&error)[4]);
};
const ArmKernel& portable_arm_kernel();
const ArmKernel& avx2_arm_kernel();
/// The one that this processor runs fastest.
const ArmKernel& arm_kernel();

}  // namespace armature
