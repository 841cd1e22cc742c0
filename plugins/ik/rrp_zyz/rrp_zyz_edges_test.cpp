// SPDX-License-Identifier: Apache-2.0
// At and next to every set where the arm loses a branch, a digit or its reach: 1000 poses each.
#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "rrp_test_arms.hpp"

namespace armature {
namespace {

using testing::another_master;
using testing::goal_at;
using testing::master;
using testing::solver_for;

constexpr int kPoses = 1000;
constexpr std::uint64_t kSeed = 20240531;

/// How a pose of the set is made from a random one; `arm` for limits, offsets.
struct Edge {
  std::string name;
  std::function<void(const RobotModel& arm, std::mt19937_64& random, JointVector& q)> place;
  /// Least distance of sin(theta2) or sin(theta5) from 0, which divides the rounding.
  double nearness = 1;

  friend void PrintTo(const Edge& edge, std::ostream* out) { *out << edge.name; }
};

double either(std::mt19937_64& random, double a, double b) {
  return std::bernoulli_distribution{}(random) ? a : b;
}
/// The value of joint `i` that puts its Denavit-Hartenberg angle `off` from 0 or from pi.
double straight(const RobotModel& arm, int i, std::mt19937_64& random, double off) {
  const double theta = arm.joints()[static_cast<std::size_t>(i)].theta;
  return wrap_angle(either(random, 0, M_PI) + either(random, off, -off) - theta);
}

std::vector<Edge> edges() {
  std::vector<Edge> all;
  for (const double off : {0.0, 1e-9, 1e-7, 1e-4}) {
    const std::string how =
        off == 0 ? "exactly" : "within_1e" + std::to_string(-std::lround(std::log10(off)));
    const double nearness = off == 0 ? 1 : off;
    all.push_back({"wrist_straight_" + how,
                   [=](auto& arm, auto& random, auto& q) { q[4] = straight(arm, 4, random, off); },
                   nearness});
    all.push_back({"goal_on_the_base_axis_" + how,
                   [=](auto& arm, auto& random, auto& q) { q[1] = straight(arm, 1, random, off); },
                   nearness});
    all.push_back({"both_" + how,
                   [=](auto& arm, auto& random, auto& q) {
                     q[1] = straight(arm, 1, random, off);
                     q[4] = straight(arm, 4, random, off);
                   },
                   nearness * nearness});
  }
  all.push_back({"stretched", [](auto& arm, auto&, auto& q) { q[2] = arm.upper()[2]; }});
  all.push_back(
      {"stretched_but_1e9", [](auto& arm, auto&, auto& q) { q[2] = arm.upper()[2] - 1e-9; }});
  all.push_back({"folded", [](auto& arm, auto&, auto& q) { q[2] = arm.lower()[2]; }});
  all.push_back({"at_joint_limits", [](auto& arm, auto& random, auto& q) {
                   for (int i = 0; i < 6; ++i) {
                     if (either(random, 0, 1) > 0)
                       q[i] = either(random, arm.lower()[i], arm.upper()[i]);
                   }
                 }});
  return all;
}

class RrpZyzEdges
    : public ::testing::TestWithParam<std::tuple<std::shared_ptr<const RobotModel>, Edge>> {
 protected:
  const RobotModel& arm() const { return *std::get<0>(GetParam()); }
  const Edge& edge() const { return std::get<1>(GetParam()); }
};

TEST_P(RrpZyzEdges, EveryBranchIsThereAndRight) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  const auto solver = solver_for(arm());
  // What rounding of the pose, divided by the sines, leaves of the generator's joints.
  const double recovered = 1e-9 + 1e-13 / edge().nearness;
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = testing::random_joints(arm(), random);
    edge().place(arm(), random, q);
    const IkGoal goal = goal_at(arm(), q);
    IkBranches found;
    IkState state;
    const IkStatus status = solver->solve(goal, q, found, state);
    ASSERT_EQ(found.count, 4) << describe(status) << " at " << q.transpose();
    double nearest = 10;
    for (const IkBranch& branch : found) {
      ASSERT_TRUE(branch.q.allFinite());
      const auto error = residual(forward_kinematics(arm(), branch.q), {}, goal.pose);
      ASSERT_LE(error.position_m, 2e-12) << branch.label << " at " << q.transpose();
      ASSERT_LE(error.angle_rad, 2e-12) << branch.label << " at " << q.transpose();
      ASSERT_NEAR(branch.residual.position_m, error.position_m, 1e-14);
      ASSERT_NEAR(branch.residual.angle_rad, error.angle_rad, 1e-14);
      JointVector turned = branch.q;
      ASSERT_EQ(branch.within_limits, unwind(arm(), branch.q, turned)) << branch.q.transpose();
      nearest = std::min(nearest, testing::distance(arm(), branch.q, q));
    }
    ASSERT_LE(nearest, recovered) << q.transpose();
    ASSERT_TRUE(status.code == IkStatus::Code::ok || !arm().within_limits(q)) << q.transpose();
  }
}

TEST_P(RrpZyzEdges, ASingularBranchIsMarked) {
  std::mt19937_64 random{kSeed};
  const auto solver = solver_for(arm());
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = testing::random_joints(arm(), random);
    edge().place(arm(), random, q);
    const double sine2 = std::sin(q[1] + arm().joints()[1].theta);
    const double sine5 = std::sin(q[4] + arm().joints()[4].theta);
    const double least = std::min(std::abs(sine2), std::abs(sine5));
    if (std::abs(least - 1e-6) < 1e-9) continue;  // at the threshold itself
    IkBranches found;
    IkState state;
    solver->solve(goal_at(arm(), q), q, found, state);
    for (const IkBranch& branch : found) ASSERT_EQ(branch.singular, least < 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, RrpZyzEdges,
                         ::testing::Combine(::testing::Values(master(), another_master()),
                                            ::testing::ValuesIn(edges())),
                         [](const auto& one) {
                           return std::get<0>(one.param)->name() + "_" +
                                  std::get<1>(one.param).name;
                         });

/// The hand straight up or down: the tool's z along the base's.
TEST(RrpZyzEdge, PointingStraightUpOrDownHasFourBranches) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  const RobotModel& arm = *master();
  const auto solver = solver_for(arm);
  for (int n = 0; n < kPoses; ++n) {
    IkGoal goal = goal_at(arm, testing::random_joints(arm, random));
    goal.pose.orientation =
        Eigen::Quaterniond{Eigen::AngleAxisd{angle(random), Eigen::Vector3d::UnitZ()} *
                           Eigen::AngleAxisd{either(random, 0, M_PI), Eigen::Vector3d::UnitX()}};
    IkBranches found;
    IkState state;
    solver->solve(goal, resting_position(arm), found, state);
    ASSERT_EQ(found.count, 4);
    for (const IkBranch& branch : found) {
      const auto error = residual(forward_kinematics(arm, branch.q), {}, goal.pose);
      ASSERT_LE(std::max(error.position_m, error.angle_rad), 1e-14) << branch.q.transpose();
    }
  }
}

TEST(RrpZyzEdge, WhatTheSlideMissesIsOutOfReachByThatMuch) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  const RobotModel& arm = *master();
  const auto solver = solver_for(arm);
  const double most = arm.upper()[2] + 0.02, least = arm.lower()[2] + 0.02;
  for (const double by : {1e-9, 0.1}) {
    for (int n = 0; n < kPoses; ++n) {
      const bool outside = either(random, 0, 1) > 0;
      const double beyond = by < 1e-3 ? by : by * (outside ? most : least);
      JointVector q = testing::random_joints(arm, random);
      q[2] = outside ? arm.upper()[2] + beyond : arm.lower()[2] - beyond;
      IkBranches found;
      IkState state;
      const IkStatus status = solver->solve(goal_at(arm, q), q, found, state);
      ASSERT_EQ(status.code, IkStatus::Code::out_of_reach) << q.transpose();
      ASSERT_NEAR(status.shortfall, beyond, 1e-15);
      ASSERT_EQ(found.count, 0);
    }
  }
}

}  // namespace
}  // namespace armature
