// SPDX-License-Identifier: Apache-2.0
// SR-1, the arm with six revolute joints: forward and inverse kinematics, singular cases, Jacobian.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "sr1_arms.hpp"

namespace armature::paper {
namespace {

constexpr double kPrinted = 1e-11;  // the figures have 12 digits

SolvedArm sr1_file() {
  return {std::make_shared<const RobotModel>(
              load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1.yaml")),
          nullptr};
}

void expect_pose(const Eigen::Isometry3d& pose, const Figures& rows) {
  EXPECT_LE((pose.matrix() - pose_of(rows).matrix()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Sr1, TheRobotFileHasTheTableAndTheLimitsOfTheModel) {
  const Figures table = sr1()["model"];
  const auto model = sr1_file().model;
  ASSERT_EQ(model->joint_count(), 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint& joint = model->joints()[i];
    EXPECT_EQ(joint.a, table["a"][i].number());
    EXPECT_NEAR(joint.alpha, table["alpha_deg"][i].number() * kRadPerDegree, 1e-15);
    EXPECT_EQ(joint.d, i < 5 ? table["d"][i].number() : 0);
    EXPECT_NEAR(joint.lower, table["limits_deg"][i][0].number() * kRadPerDegree, 1e-15);
    EXPECT_NEAR(joint.upper, table["limits_deg"][i][1].number() * kRadPerDegree, 1e-15);
    EXPECT_NEAR(joint.max_velocity, table["vmax_deg_s"][i].number() * kRadPerDegree, 1e-6);
    EXPECT_NEAR(joint.max_acceleration, 4 * joint.max_velocity, 1e-5);
  }
  EXPECT_EQ(model->frame(model->tool()).parent_T_frame.translation().z(),
            sr1()["minmax"]["tool_d6"].number());
}

TEST(Sr1, ForwardKinematicsGivesTheReferenceMatricesOfTheSingularPoses) {
  const Figures cases = sr1()["singular_cases"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double d6 = cases[i].has("d6") ? cases[i]["d6"].number() : 0;
    const SolvedArm arm = sr1_with_tool(d6);
    expect_pose(forward_kinematics(*arm.model, cases[i]["q"].numbers()), cases[i]["T"]);
  }
}

/// All listed branches of a case, and no others. The wrist's flag is the reference's.
void expect_branches(const SolvedArm& arm, const Figures& row, double tolerance) {
  IkBranches found;
  arm.solve(goal_of(pose_of(row["T"])), JointVector::Zero(6), found);
  const Figures wanted = row["branches"];
  ASSERT_EQ(static_cast<std::size_t>(found.count), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const IkBranch& branch = found.branch[i];
    EXPECT_EQ(branch.label, label_of(wanted[i]["s1_s3_s5"]));
    EXPECT_LE(test::joint_distance(branch.q, wanted[i]["q"].numbers()), tolerance) << branch.label;
    EXPECT_EQ(branch.singular, wanted[i]["wrist_singular"].text() == "true") << branch.label;
    EXPECT_LE(branch.residual.position_m, 1e-11);
    EXPECT_LE(branch.residual.angle_rad, 1e-11);
  }
}

TEST(Sr1, WithTheWristInLineTheSumOfTheRollsIsFound) {
  const Figures row = sr1()["singular_cases"][0];
  expect_branches(sr1_with_tool(row["d6"].number()), row, 5 * kPrinted);
}

TEST(Sr1, AtTheElbowsAndTheShouldersSingularSetBothRootsAreOne) {
  const SolvedArm arm = sr1_with_tool(0);
  for (const std::size_t which : {1U, 2U}) {
    const Figures row = sr1()["singular_cases"][which];
    SCOPED_TRACE(row["name"].text());
    const JointVector q = row["q"].numbers();
    IkBranches found;
    arm.solve(goal_of(pose_of(row["T"])), q, found);
    ASSERT_EQ(found.count, 8);
    const std::size_t pair = which == 1 ? 2 : 4;  // the branch with the other elbow, or shoulder
    for (std::size_t i = 0; i < 8; i += which == 1 ? 4 : 1) {
      if (which == 2 && i >= 4) break;
      EXPECT_TRUE(found.branch[i].singular);
      EXPECT_LE(test::joint_distance(found.branch[i].q, found.branch[i + pair].q), 1e-5);
    }
    double nearest = 1;
    for (const IkBranch& branch : found) {
      nearest = std::min(nearest, test::joint_distance(branch.q, q));
    }
    EXPECT_LE(nearest, 1e-5);  // the root of what 12 digits leave
  }
}

TEST(Sr1, ThePoseBeyondReachHasNoBranch) {
  IkBranches found;
  const Eigen::Isometry3d pose = pose_of(sr1()["unreachable_case"]["T"]);
  const SolvedArm arm = sr1_with_tool(0);
  const IkStatus status = arm.solve(goal_of(pose), JointVector::Zero(6), found);
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_EQ(found.count, 0);
  EXPECT_NEAR(status.shortfall, std::hypot(0.9136, 0.0203) - 0.4318 - std::hypot(0.4318, 0.0203),
              1e-12);
}

TEST(Sr1, TheStartOfThePlannedPathHasTheReferencesJointsInEveryBranch) {
  const Figures plan = sr1()["minmax"];
  Eigen::Isometry3d home = Eigen::Isometry3d::Identity();
  home.translation() = plan["home"].numbers();
  for (std::size_t i = 0; i < 3; ++i) {
    home.linear().row(static_cast<Eigen::Index>(i)) = plan["R"][i].numbers();
  }
  IkBranches found;
  const SolvedArm arm = sr1_with_tool(plan["tool_d6"].number());  // its library holds the labels
  arm.solve(goal_of(home), JointVector::Zero(6), found);
  ASSERT_EQ(static_cast<std::size_t>(found.count), plan["branches"].size());
  for (std::size_t i = 0; i < 8; ++i) {
    const Figures wanted = plan["branches"][i];
    EXPECT_EQ(found.branch[i].label, label_of(wanted["s1_s3_s5"]));
    EXPECT_LE(test::joint_distance(found.branch[i].q, kRadPerDegree * wanted["q0_deg"].numbers()),
              1e-10);
  }
}

TEST(Sr1, TheDeterminantOfTheJacobianIsTheClosedForm) {
  constexpr double a1 = 0.08, a2 = 0.4318, a3 = 0.0203, d4 = 0.4318;
  const SolvedArm arm = sr1_with_lengths(0.3, a1, a3, 0);
  SCOPED_TRACE("seed 5");
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  for (int i = 0; i < 2000; ++i) {
    JointVector q(6);
    for (double& value : q) value = angle(random);
    const double c2 = std::cos(q[1]), c3 = std::cos(q[2]), s3 = std::sin(q[2]);
    const double c23 = std::cos(q[1] + q[2]), s23 = std::sin(q[1] + q[2]);
    const double closed =
        -a2 * (d4 * c3 + a3 * s3) * (a1 + a2 * c2 + a3 * c23 - d4 * s23) * std::sin(q[4]);
    const Eigen::Matrix<double, 6, 6> jacobian =
        forward_kinematics_with_jacobian(*arm.model, q, arm.model->tool()).jacobian;
    EXPECT_NEAR(jacobian.determinant(), closed, 1e-14);
  }
}

/// Forward kinematics of the inverse for joints all the way round.
struct RoundTrips {
  double largest_residual = 0, joints_recovered = 0;
  std::map<int, int> branches;  // how many poses had how many
};
RoundTrips round_trips(const SolvedArm& arm, int poses) {
  std::mt19937_64 random{2005};
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  RoundTrips result;
  IkBranches found;
  for (int i = 0; i < poses; ++i) {
    JointVector q(6);
    for (double& value : q) value = angle(random);
    const IkGoal goal = goal_of(forward_kinematics(*arm.model, q));
    arm.solve(goal, q, found);
    double nearest = 10;
    for (const IkBranch& branch : found) {
      const PoseResidual actual =
          residual(forward_kinematics(*arm.model, branch.q), Eigen::Vector3d::UnitZ(), goal.pose);
      result.largest_residual =
          std::max({result.largest_residual, actual.position_m, actual.angle_rad});
      nearest = std::min(nearest, test::joint_distance(branch.q, q));
    }
    result.joints_recovered = std::max(result.joints_recovered, nearest);
    ++result.branches[found.count];
  }
  return result;
}

TEST(Sr1, AHundredThousandPosesGoRoundWithEveryBranch) {
  constexpr int kPoses = 100000;
  SCOPED_TRACE("seed 2005");
  const SolvedArm plain = sr1_with_tool(0), tooled = sr1_with_lengths(0.3, 0, 0.0203, 0.25);
  for (const SolvedArm* arm : {&plain, &tooled}) {
    const RoundTrips trips = round_trips(*arm, kPoses);
    EXPECT_LE(trips.largest_residual, 1e-14);
    EXPECT_LE(trips.joints_recovered, 1e-6);
    EXPECT_EQ(trips.branches, (std::map<int, int>{{8, kPoses}}));
  }
}

TEST(Sr1, WithALengthBetweenTheFirstTwoAxesSomePosesHaveOneShoulderOnly) {
  constexpr int kPoses = 100000;
  SCOPED_TRACE("seed 2005");
  const RoundTrips trips = round_trips(sr1_with_lengths(0, 0.08, -0.0203, 0.12), kPoses);
  EXPECT_LE(trips.largest_residual, 1e-14);
  EXPECT_LE(trips.joints_recovered, 1e-6);
  ASSERT_EQ(trips.branches.size(), 2U);
  EXPECT_NEAR(trips.branches.at(8) / static_cast<double>(kPoses), 0.837, 0.005);
  EXPECT_NEAR(trips.branches.at(4) / static_cast<double>(kPoses), 0.163, 0.005);
}

}  // namespace
}  // namespace armature::paper
