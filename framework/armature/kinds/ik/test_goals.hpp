// SPDX-License-Identifier: Apache-2.0
// What tests of solvers ask, and how they compare what comes.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::test {

/// The position and the rotation of the tool at `q`.
inline IkGoal goal_at(const RobotModel& model, const JointVector& q) {
  const Eigen::Isometry3d pose = forward_kinematics(model, q);
  IkGoal goal;
  goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
  return goal;
}

/// Uniform inside the limits; every joint has some.
template <class Random>
JointVector random_joints(const RobotModel& model, Random& random) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    q[i] = std::uniform_real_distribution{model.lower()[i], model.upper()[i]}(random);
  }
  return q;
}

/// Largest difference of joints that turn [rad], whole turns aside.
inline double joint_distance(const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(wrap_angle(a[i] - b[i])));
  }
  return largest;
}

}  // namespace armature::test
