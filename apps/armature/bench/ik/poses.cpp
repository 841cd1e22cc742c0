// SPDX-License-Identifier: Apache-2.0
#include "bench/ik/poses.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "armature/robot/kinematics/task_error.hpp"
#include "armature/values/angles.hpp"
#include "bench/random_joints.hpp"

namespace armature::bench {
namespace {

JointVector next_to(const RobotModel& model, const JointVector& q, std::mt19937_64& random) {
  JointVector near = q;
  for (int i = 0; i < model.dof(); ++i) {
    const auto [lower, upper] = range(model, i);
    const double most = model.is_revolute(i) ? 5 * kRadPerDegree : 0.025 * (upper - lower);
    near[i] = std::clamp(q[i] + (2 * unit(random) - 1) * most, lower, upper);
  }
  return near;
}

}  // namespace

std::string_view to_string(Seeds seeds) { return seeds == Seeds::random ? "random" : "near"; }

std::vector<Pose> poses(const RobotModel& model, int count, std::uint64_t seed, double tolerance) {
  std::mt19937_64 random{seed};
  std::vector<Pose> list(static_cast<std::size_t>(count));
  for (Pose& pose : list) {
    pose.q = anywhere(model, random);
    pose.goal.pose = task_pose(model, pose.q);
    pose.goal.tolerance = {.position_m = tolerance, .angle_rad = tolerance};
    pose.random = anywhere(model, random);
    pose.near = next_to(model, pose.q, random);
  }
  return list;
}

}  // namespace armature::bench
