// SPDX-License-Identifier: Apache-2.0
// Jiang et al. 2021, sections 1 to 3.2: forward and inverse kinematics.
#include <gtest/gtest.h>

#include <random>

#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "paper_lamp.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

JointVector contracted(const Eigen::VectorXd& all) {
  return paper_lamp().model().to_independent(all).value();
}

TEST(DentalLamp, TheRobotFileHasTheLengthsOfTable1) {
  const Figures rows = dental_lamp()["dh_standard"];
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(paper_lamp().model().joints()[i].d, 1e-3 * rows[i]["d"].number(), 1e-12);
    EXPECT_NEAR(paper_lamp().model().joints()[i].a, 1e-3 * rows[i]["a"].number(), 1e-12);
    EXPECT_NEAR(paper_lamp().model().joints()[i].alpha, rows[i]["alpha"].number(), 1e-12);
  }
}

TEST(DentalLamp, ForwardKinematicsGivesEveryReferenceMatrix) {
  const Figures cases = dental_lamp()["fk_cases"];
  ASSERT_EQ(cases.size(), 4u);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(cases[i]["name"].text());
    const Eigen::Isometry3d pose =
        forward_kinematics(paper_lamp().model(), contracted(cases[i]["q"].numbers()));
    for (std::size_t row = 0; row < 3; ++row) {
      const Eigen::VectorXd wanted = cases[i]["T"][row].numbers();
      for (Eigen::Index column = 0; column < 4; ++column) {
        const bool is_length = column == 3;
        EXPECT_NEAR(pose(static_cast<Eigen::Index>(row), column),
                    (is_length ? 1e-3 : 1) * wanted[column], is_length ? 1e-11 : 2e-9);
      }
    }
  }
}

TEST(DentalLamp, TheExampleOfEquation40IsSolvedAsCorrectedAndNotAsPrinted) {
  const Figures example = dental_lamp()["ik_example"];
  const Eigen::Vector3d direction = example["target"]["x7"].numbers().head<3>();
  const JointVector q = paper_lamp().joints(example["target"]["P"].point_m(), direction);
  EXPECT_LE(
      (paper_lamp().all_joints(q) - example["recomputed_theta"].numbers()).cwiseAbs().maxCoeff(),
      1e-9);
  const Figures literal = example["literal_print_gives"];
  EXPECT_GT(std::abs(q[0] - literal["theta1_eq31"].number()), 0.01);
  EXPECT_GT(std::abs(q[1] - literal["theta2_eq34"].number()), 0.01);
  EXPECT_GT(std::abs(q[2] - literal["theta3_eq26_arccos"].number()), 0.01);
  EXPECT_GT(std::abs(q[3] - literal["theta5_eq39"].number()), 0.01);
}

/// Every listed solution under its label, and no other.
void expect_solutions(const Figures& row, double tolerance) {
  const Eigen::Vector3d direction = row["x7"].numbers().head<3>();
  const IkBranches found = paper_lamp().branches(row["P"].point_m(), direction);
  const Figures wanted = row["solutions"];
  ASSERT_EQ(static_cast<std::size_t>(found.count), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Eigen::VectorXd bits = wanted[i]["branch"].numbers();
    const std::string label = "tilt" + std::to_string(static_cast<int>(bits[0])) + "/balance" +
                              std::to_string(static_cast<int>(bits[1])) + "/elbow" +
                              std::to_string(static_cast<int>(bits[2]));
    EXPECT_EQ(found.branch[i].label, label);
    EXPECT_LE(
        test::joint_distance(paper_lamp().all_joints(found.branch[i].q), wanted[i]["q"].numbers()),
        tolerance)
        << label << ": " << paper_lamp().all_joints(found.branch[i].q).transpose();
    EXPECT_LE(found.branch[i].residual.position_m, 1e-9);
    EXPECT_LE(found.branch[i].residual.angle_rad, 1e-9);
  }
}

TEST(DentalLamp, EveryBranchOfEveryReferencePoseIsFoundUnderItsName) {
  const Figures rows = dental_lamp()["ik_branches"];
  ASSERT_EQ(rows.size(), 12u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE("pose " + std::to_string(i));
    expect_solutions(rows[i], 2e-6);  // the poses are printed to 1e-7 m
  }
}

TEST(DentalLamp, SpecialPosesHaveTheSolutionsOfTheReference) {
  const Figures rows = dental_lamp()["ik_special"];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i]["name"].text());
    if (rows[i]["n_solutions"].text() == "infinite") {
      const Eigen::Vector3d direction = rows[i]["x7"].numbers().head<3>();
      EXPECT_GE(paper_lamp().branches(rows[i]["P"].point_m(), direction).count, 2);
    } else {
      expect_solutions(rows[i], 1e-8);
    }
  }
}

TEST(DentalLamp, NumericAndClosedFormAgreeNearTheWork) {
  SCOPED_TRACE("seed 42");
  std::mt19937_64 random{42};
  std::uniform_real_distribution<double> unit{-1, 1};
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    JointVector q(5);
    q << 1.0 + 0.6 * unit(random), -1.7 + 0.6 * unit(random), 0.4 * unit(random),
        0.8 + 0.8 * unit(random), 0.5 * unit(random);
    const Eigen::Isometry3d pose = forward_kinematics(paper_lamp().model(), q);
    IkGoal goal;
    goal.pose = {pose.translation(), Direction{pose.linear().col(0)}};
    const JointVector seed = q + 0.15 * JointVector::Random(5);
    IkBranches numeric;
    IkState state;
    ASSERT_EQ(paper_lamp().ik("ik/numeric").solve(goal, seed, numeric, state).code,
              IkStatus::Code::ok);
    const IkBranches closed = paper_lamp().branches(goal.pose.position, pose.linear().col(0));
    double nearest = 1;
    for (const IkBranch& branch : closed) {
      nearest = std::min(nearest, test::joint_distance(branch.q, numeric.begin()->q));
    }
    EXPECT_LE(nearest, 1e-6);
    EXPECT_LE(numeric.begin()->residual.position_m, 1e-9);
    ++compared;
  }
  EXPECT_EQ(compared, 2000);
}

TEST(DentalLamp, TheNineSearchPosesHaveTheReferencesJoints) {
  const Figures poses = dental_lamp()["face_search"]["poses"];
  ASSERT_EQ(poses.size(), 9u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double yaw = poses[i]["yaw_deg"].number() * kRadPerDegree;
    const double pitch = poses[i]["pitch_deg"].number() * kRadPerDegree;
    const Eigen::Vector3d direction{std::cos(pitch) * std::cos(yaw),
                                    std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
    const Eigen::Vector3d joint6{0.798, 0, 0.505};
    EXPECT_LE((joint6 + 0.08 * direction - poses[i]["P7"].point_m()).norm(), 1e-7);
    const JointVector q = paper_lamp().joints(joint6 + 0.08 * direction, direction);
    EXPECT_LE((paper_lamp().all_joints(q) - poses[i]["q"].numbers()).cwiseAbs().maxCoeff(), 2e-8);
    EXPECT_LE((paper_lamp().all_joints(q) / kRadPerDegree - poses[i]["q_deg"].numbers())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-4);
  }
}

}  // namespace
}  // namespace armature::paper
