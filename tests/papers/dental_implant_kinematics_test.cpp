// SPDX-License-Identifier: Apache-2.0
// Zhong et al.: the LBR Med 7 of a dental-implant robot. The kinematic figures of
// tests/data/dental_implant_reference.yaml, against the plugin as it is deployed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/geometry/guided_chain.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/angles.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

constexpr double kPrinted = 1e-11;  // the figures have 12 digits

const RobotModel& med7() {
  static const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  return model;
}

/// ik/srs_arm_angle as a deployment makes it.
const IkSolver& solver(const std::string& objective) {
  static std::map<std::string, PluginPtr<IkSolver>> made;
  const auto found = made.find(objective);
  if (found != made.end()) return *found->second;
  const Params params = declared_params(ARMATURE_SOURCE_DIR "/plugins/ik/srs_arm_angle/plugin.yaml",
                                        "{objective: " + objective + "}");
  auto one = built_plugins().make<IkSolver>("ik/srs_arm_angle", med7(), params);
  return *made.emplace(objective, std::move(one.value())).first->second;
}

Eigen::Isometry3d flange_T_tool() {
  const Eigen::Isometry3d base_T_flange =
      forward_kinematics(med7(), *med7().home(), *med7().find_frame("flange"));
  return base_T_flange.inverse() * forward_kinematics(med7(), *med7().home());
}

/// Goals of the robot file are of the drill, the reference's are of the flange.
IkGoal goal_of(const Eigen::Isometry3d& base_T_flange) {
  const Eigen::Isometry3d base_T_tool = base_T_flange * flange_T_tool();
  IkGoal goal;
  goal.pose = {base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}};
  return goal;
}

Eigen::Isometry3d pose_of(const Figures& rotation, const Figures& position) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t row = 0; row < 3; ++row) {
    pose.linear().row(static_cast<Eigen::Index>(row)) = rotation[row].numbers();
  }
  pose.translation() = position.numbers();
  return pose;
}

/// The reference's signs of elbow, shoulder and wrist.
std::string label_of(const Figures& g4_g2_g6) {
  const Eigen::VectorXd g = g4_g2_g6.numbers();
  const auto digit = [&](Eigen::Index i) { return std::string{g[i] > 0 ? "0" : "1"}; };
  return "shoulder" + digit(1) + "/elbow" + digit(0) + "/wrist" + digit(2);
}

const IkBranch& branch_named(const IkBranches& found, const std::string& label) {
  return *std::ranges::find(found, label, &IkBranch::label);
}

IkBranches solve(const IkGoal& goal, const JointVector& seed,
                 const std::string& objective = "limits") {
  IkBranches found;
  IkState state;
  solver(objective).solve(goal, seed, found, state);
  return found;
}

TEST(DentalImplantArm, TheRobotFileHasTheLengthsLimitsAndSpeedsOfTheMed7) {
  const Figures srs = dental_implant()["srs"];
  const auto& joints = med7().joints();
  EXPECT_EQ(joints[0].d, srs["d_bs"].number());
  EXPECT_EQ(joints[2].d, srs["d_se"].number());
  EXPECT_EQ(joints[4].d, srs["d_ew"].number());
  EXPECT_EQ(joints[6].d, srs["d_wf"].number());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(joints[i].upper, srs["limits_deg"][i].number() * kRadPerDegree, 1e-15);
    EXPECT_EQ(joints[i].lower, -joints[i].upper);
    EXPECT_NEAR(joints[i].max_velocity, srs["vmax_deg_s"][i].number() * kRadPerDegree, 1e-6);
    EXPECT_NEAR(joints[i].max_acceleration, 4 * joints[i].max_velocity, 2e-6);
  }
}

TEST(DentalImplantArm, ForwardKinematicsGivesEveryReferencePose) {
  const Figures cases = dental_implant()["srs"]["cases"];
  ASSERT_EQ(cases.size(), 4U);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const JointVector q = kRadPerDegree * cases[i]["q_deg"].numbers();
    const Eigen::Isometry3d pose = forward_kinematics(med7(), q, *med7().find_frame("flange"));
    const Eigen::Isometry3d wanted = pose_of(cases[i]["R"], cases[i]["p"]);
    EXPECT_LE((pose.matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(*solver("limits").redundancy_of(q), cases[i]["psi"].number(), kPrinted);
  }
}

TEST(DentalImplantArm, EveryBranchOfEveryPoseIsFoundUnderItsNameAtTheReferencesArmAngle) {
  const Figures cases = dental_implant()["srs"]["cases"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    IkGoal goal = goal_of(pose_of(cases[i]["R"], cases[i]["p"]));
    goal.redundancy = cases[i]["psi"].number();
    const IkBranches found = solve(goal, *med7().home());
    const Figures wanted = cases[i]["all_branches_same_psi"];
    ASSERT_EQ(static_cast<std::size_t>(found.count), wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const IkBranch& branch = branch_named(found, label_of(wanted[k]["g4_g2_g6"]));
      EXPECT_LE(test::joint_distance(branch.q, wanted[k]["q"].numbers()), 3 * kPrinted)
          << branch.label;
      EXPECT_EQ(branch.within_limits, wanted[k]["within_limits"].text() == "true") << branch.label;
    }
    const JointVector q = kRadPerDegree * cases[i]["q_deg"].numbers();
    EXPECT_LE(test::joint_distance(branch_named(found, label_of(cases[i]["branch"])).q, q),
              3 * kPrinted);
  }
}

TEST(DentalImplantArm, EveryArmAngleIntervalOfTheReferenceIsFoundAndNoOther) {
  const Figures cases = dental_implant()["srs"]["cases"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    RedundancyIntervals found;
    const IkGoal goal = goal_of(pose_of(cases[i]["R"], cases[i]["p"]));
    ASSERT_TRUE(solver("limits").feasible_redundancy(goal, *med7().home(), found));
    const Figures wanted = cases[i]["intervals_deg"];
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const std::string label = label_of(wanted[k]["g4_g2_g6"]);
      std::vector<RedundancyInterval> own;
      std::ranges::copy_if(found, std::back_inserter(own),
                           [&](const auto& interval) { return interval.label == label; });
      const Figures printed = wanted[k]["psi"];
      ASSERT_EQ(own.size(), printed.size()) << label;
      for (std::size_t n = 0; n < own.size(); ++n) {
        EXPECT_NEAR(own[n].lower, printed[n][0].number() * kRadPerDegree, 1e-10) << label;
        EXPECT_NEAR(own[n].upper, printed[n][1].number() * kRadPerDegree, 1e-10) << label;
      }
    }
  }
}

/// The reference's H of the joints.
double balanced_cost(const JointVector& q) {
  double cost = 0;
  for (int i = 0; i < 7; ++i) {
    const double x = q[i] / med7().upper()[i];
    cost += x * x / (1 - x * x);
  }
  const auto singular = [](double angle) { return 1 / (std::pow(std::sin(angle), 2) + 1e-3); };
  return cost + 0.02 * (singular(q[1]) + singular(q[5]));
}

TEST(DentalImplantArm, TheBestOfAllBranchesIsTheReferencesOptimum) {
  const Figures cases = dental_implant()["srs"]["cases"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    const Figures best = cases[i]["best"];
    const IkBranches found =
        solve(goal_of(pose_of(cases[i]["R"], cases[i]["p"])), *med7().home(), "balanced");
    const IkBranch* least = nullptr;
    for (const IkBranch& branch : found) {
      if (!branch.within_limits) continue;
      if (!least || balanced_cost(branch.q) < balanced_cost(least->q)) least = &branch;
    }
    ASSERT_TRUE(least);
    EXPECT_EQ(least->label, label_of(best["g4_g2_g6"]));
    EXPECT_NEAR(balanced_cost(least->q), best["H"].number(), kPrinted);
    // A flat bottom: the reference knows its place to the root of 1e-16.
    EXPECT_NEAR(least->redundancy, best["psi"].number(), 1e-7);
    EXPECT_LE(test::joint_distance(least->q, best["q"].numbers()), 1e-7);
  }
}

TEST(DentalImplantArm, TheDrillComesToTheImplantThroughTheChainOfFrames) {
  const Figures frames = dental_implant()["frames"];
  GuidedChain chain;
  chain.base_T_tracker = frames["T_R_N"].transform();
  chain.tracker_T_patient = frames["T_N_M"].transform();
  chain.patient_T_image = frames["T_M_P"].transform();
  const Eigen::Isometry3d flange_T_drill = frames["T_F_D"].transform();
  chain.tip = flange_T_drill.translation();  // the body sits where the flange is
  chain.flange_R_tool = flange_T_drill.linear();
  EXPECT_LE((flange_T_tool().matrix() - flange_T_drill.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::Isometry3d patient_T_implant = frames["T_P_implant"].transform();
  const Eigen::Isometry3d robot_T_implant = chain.base_T_site(patient_T_implant);
  const Eigen::Isometry3d command = chain.base_T_flange(patient_T_implant);
  EXPECT_LE((command.matrix() - frames["T_R_F_command"].transform().matrix()).cwiseAbs().maxCoeff(),
            1e-11);
  IkGoal goal;
  goal.pose = {robot_T_implant.translation(),
               Eigen::Quaterniond{robot_T_implant.linear()}.normalized()};
  const JointVector q = frames["q_solution_example"].numbers();
  goal.redundancy = solver("limits").redundancy_of(q);
  double nearest = 10;
  for (const IkBranch& branch : solve(goal, *med7().home())) {
    nearest = std::min(nearest, test::joint_distance(branch.q, q));
  }
  EXPECT_LE(nearest, 1e-10);
}

TEST(DentalImplantArm, TheJacobiansSingularSetsAreThoseOfTheReference) {
  SCOPED_TRACE("seed 7");
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> angle{0.3, 1.2};
  for (int i = 0; i < 300; ++i) {
    JointVector regular(7);
    for (double& value : regular) value = angle(random);
    const auto volume = [&](std::initializer_list<std::pair<int, double>> changed) {
      JointVector q = regular;
      for (const auto& [joint, value] : changed) q[joint] = value;
      return manipulability(med7(), q);
    };
    EXPECT_LE(volume({{3, 0}}), 1e-15);
    EXPECT_LE(volume({{1, 0}, {2, M_PI / 2}}), 1e-15);
    EXPECT_LE(volume({{1, 0}, {2, -M_PI / 2}}), 1e-15);
    EXPECT_LE(volume({{5, 0}, {4, M_PI / 2}}), 1e-15);
    EXPECT_LE(volume({{5, 0}, {4, -M_PI / 2}}), 1e-15);
    EXPECT_LE(volume({{1, 0}, {5, 0}}), 1e-15);
    // One axis in line alone leaves the hand free.
    EXPECT_GE(volume({{1, 0}}), 1e-3);
    EXPECT_GE(volume({{5, 0}}), 1e-3);
  }
}

}  // namespace
}  // namespace armature::paper
