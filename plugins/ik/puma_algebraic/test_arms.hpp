// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>

#include "armature/kinds/ik/contract/probe.hpp"
#include "puma_structure.hpp"

namespace armature {

using ModelPtr = std::shared_ptr<const RobotModel>;

/// configs/robots/sr1.yaml and sr1_needle.yaml.
ModelPtr sr1();
ModelPtr sr1_needle();
/// The same with the guide's axis as pointing axis.
ModelPtr sr1_pointing();
/// The PUMA 560 in the standard convention (lengths and limits of P. Corke's model).
ModelPtr standard_puma560();
/// A standing industrial arm: a1, no d2, tool turned and shifted.
ModelPtr industrial_arm();
/// `model` with joints that turn all the way.
ModelPtr without_limits(const RobotModel& model);

/// Any six rows, and the tool on the last one.
ModelPtr arm_of(RobotModel::Convention convention, std::vector<Joint> joints,
                const Eigen::Isometry3d& last_T_tool = Eigen::Isometry3d::Identity(),
                std::optional<Eigen::Vector3d> axis = {});
/// Random lengths, signs, offsets, base and tool of the pattern; joints that turn all the way.
ModelPtr random_arm(std::mt19937_64& random);

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model);
/// Asks the solver of an arm.
class PumaTest : public testing::Test {
 protected:
  static constexpr int kSeed = 20260116;

  explicit PumaTest(const ModelPtr& model = sr1()) { use(model); }
  void use(const ModelPtr& model);
  const RobotModel& model() const { return *subject_.model; }
  double any(double lower, double upper) {
    return std::uniform_real_distribution{lower, upper}(random_);
  }
  JointVector random_joints() { return probe_->random_joints(); }
  /// A goal for the full rotation, or for the pointing axis, that the joints `q` reach.
  IkGoal rotation_goal(const JointVector& q) const;
  IkGoal direction_goal(const JointVector& q) const { return probe_->goal_at(q); }
  const IkStatus& solve(const IkGoal& goal, const JointVector& seed);
  /// Forward kinematics of every branch are the goal to within `tolerance` [m] and [rad], and the
  /// residual that is told is the one that is there.
  void expect_right(double tolerance) const;

  IkSubject subject_;
  PumaArm arm_;
  std::mt19937_64 random_{kSeed};
  std::optional<ik_contract::Probe> probe_;  // what was asked, too
  IkBranches found_;
  testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(kSeed)};
};

}  // namespace armature
