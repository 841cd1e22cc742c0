// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/ik/test_goals.hpp"
#include "srs_structure.hpp"

namespace armature {

using ModelPtr = std::shared_ptr<const RobotModel>;
using test::goal_at;
using test::joint_distance;
using test::random_joints;
using Angles = std::array<double, 7>;  // t1 to t7 of SrsArm

/// A robot that tests are made for.
struct ArmSubject {
  std::string name;
  ModelPtr model;
  friend void PrintTo(const ArmSubject& subject, std::ostream* out) { *out << subject.name; }
};

/// configs/robots/med7.yaml, and the same with the bare flange for its tool.
ModelPtr med7();
ModelPtr med7_flange();
/// Upper arm and forearm of different lengths, offsets, turned axes, narrow and uneven limits, the
/// modified convention.
ModelPtr uneven_arm();
/// The Med 7's flange with narrow limits, some of them not around zero.
ModelPtr narrow_arm();
/// `model` with joints that turn all the way.
ModelPtr without_limits(const RobotModel& model);
/// `model` with other joints.
ModelPtr with_joints(const RobotModel& model, std::vector<Joint> joints);

/// Random lengths, signs, offsets, base and tool of the pattern; joints that turn all the way.
RobotModel random_arm(std::mt19937_64& random);

/// ik/srs_arm_angle with an objective ("" for the plugin's default).
std::shared_ptr<const IkSolver> solver_for(const RobotModel& model,
                                           const std::string& objective = "");

/// Joints within limits, each by a chance of one half at an end of its range.
JointVector joints_at_limits(const RobotModel& model, std::mt19937_64& random);
JointVector joints_of(const SrsArm& arm, const Angles& t);
Angles angles_of(const SrsArm& arm, const JointVector& q);

}  // namespace armature
