// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/model/robot_model.hpp"

// How vectors are passed differs between processors; here they only ever are inside one file.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace armature::ik::numeric::descent {

/// Four doubles that the processor works on at once; vectors of space leave the last one zero.
using Lanes = double __attribute__((vector_size(32)));

/// A robot as the descent walks along it: every joint is a constant step and then a turn about, or
/// a slide along, the z axis that it led to.
struct Chain {
  struct Step {
    Lanes x, y, z, origin;  // of the constant transform, columns
    bool prismatic;
    int independent;
    double ratio, offset;  // the joint's value is ratio * q[independent] + offset
  };
  int joints = 0, dof = 0;
  std::array<Step, kMaxJoints> step;
  Lanes tool_x, tool_y, tool_z, tool_origin;
  Lanes pointing_axis;  // of the tool frame
  // Of the independent joints.
  std::array<double, kMaxJoints> lower, upper;
  std::array<double, kMaxJoints> per_longest_step;  // one by it [1/rad] or [1/m]
};
Chain chain_of(const RobotModel& model);

/// A goal in numbers: unit axes or a unit direction, and how near is enough.
struct Goal {
  Lanes position;
  Lanes x, y, z;  // base_R_tool; of a pointing goal only x, the direction
  bool pointing;
  double position_m, chord;  // chord: twice the sine of half the angle that may be left
};
Goal goal_of(const IkGoal& goal);

/// A bit for every independent joint.
using JointSet = std::uint32_t;
inline constexpr JointSet kAllJoints = ~JointSet{0};

/// What one start came to.
struct End {
  std::array<double, kMaxJoints> q;
  double position_m, angle_rad;  // what is left
  double error;                  // both together, as a length
  double gram;                   // det(J J^T): manipulability squared
  bool reached = false;
  JointSet locked = 0;    // what shall stay where it starts
  JointSet bounded = 0;   // what shall keep its limits all the way
  JointSet pressing = 0;  // what the last step would have taken beyond its limits
};

/// Levenberg-Marquardt from `end.q`; `budget` counts down with every iteration. Real-time safe.
using Descend = void (*)(const Chain& chain, const Goal& goal, int& budget, End& end);
/// How far the tool is from the goal at `q`, as a length. Real-time safe.
using Measure = double (*)(const Chain& chain, const Goal& goal, const double* q);

struct Kernel {
  Descend descend;
  Measure measure;
};
/// The same source compiled twice: for every processor, and for those with AVX2 and FMA.
const Kernel& portable_kernel();
const Kernel& avx2_kernel();
/// The one that this processor runs fastest.
const Kernel& kernel();

}  // namespace armature::ik::numeric::descent
