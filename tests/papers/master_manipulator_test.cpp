// SPDX-License-Identifier: Apache-2.0
// Wang, Guan, Cao: the master manipulator of a urology robot. Every figure of
// tests/data/master_manipulator_reference.yaml, against the plugins as they are deployed.
#include <gtest/gtest.h>

#include <random>

#include "armature/config/document.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/angles.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

constexpr double kMillimetre = 1e-3;

Figures reference() {
  static const config::Node file =
      config::parse_file(ARMATURE_SOURCE_DIR "/tests/data/master_manipulator_reference.yaml");
  return Figures{file};
}

const RobotModel& master() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/master.yaml");
  return model;
}

Params defaults(const std::string& id) {
  return declared_params(ARMATURE_SOURCE_DIR "/plugins/" + id + "/plugin.yaml");
}

/// The reference counts joint 3 in millimetres.
JointVector joints(const Figures& figures) {
  JointVector q = figures.numbers();
  q[2] *= kMillimetre;
  return q;
}

IkBranches solve(const Eigen::Isometry3d& pose) {
  static const auto solver = std::move(
      built_plugins().make<IkSolver>("ik/rrp_zyz", master(), defaults("ik/rrp_zyz")).value());
  IkGoal goal;
  goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
  IkBranches found;
  IkState state;
  solver->solve(goal, JointVector::Zero(6), found, state);
  return found;
}

/// Largest difference, whole turns aside.
double difference(const JointVector& a, const JointVector& b) {
  double largest = std::abs(a[2] - b[2]);
  for (const int i : {0, 1, 3, 4, 5})
    largest = std::max(largest, std::abs(wrap_angle(a[i] - b[i])));
  return largest;
}

void expect_matrix(const Eigen::Isometry3d& pose, const Figures& wanted) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      const double unit = column == 3 ? kMillimetre : 1;
      EXPECT_NEAR(pose(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)),
                  unit * wanted[row][column].number(), 1e-12);
    }
  }
}

void expect_branches(const Eigen::Isometry3d& pose, const Figures& wanted) {
  const IkBranches found = solve(pose);
  ASSERT_EQ(static_cast<std::size_t>(found.count), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_LE(difference(found.branch[i].q, joints(wanted[i])), 2e-11) << found.branch[i].label;
  }
}

TEST(MasterManipulator, TheRobotFileHasTheModelsRows) {
  const Figures model = reference()["model"];
  const auto& rows = master().joints();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(rows[i].alpha, model["alpha_deg"][i].number() * kRadPerDegree, 1e-15);
    EXPECT_EQ(rows[i].a, model["a"][i].number());
    EXPECT_NEAR(rows[i].theta, model["theta_offset_deg"][i].number() * kRadPerDegree, 1e-15);
    EXPECT_EQ(rows[i].d, i == 2 ? model["l3"].number() * kMillimetre : 0);
  }
}

TEST(MasterManipulator, PositionIsThePapersFormulaAndIndependentOfTheWrist) {
  SCOPED_TRACE("seed 3");
  std::mt19937 random{3};
  std::uniform_real_distribution<double> angle{-M_PI, M_PI}, slide{0, 0.2};
  for (int n = 0; n < 1000; ++n) {
    JointVector q(6);
    q << angle(random), angle(random), slide(random), angle(random), angle(random), angle(random);
    const Eigen::Vector3d p =
        (q[2] + 0.02) * Eigen::Vector3d{std::sin(q[0]) * std::sin(q[1]), std::cos(q[1]),
                                        std::cos(q[0]) * std::sin(q[1])};
    ASSERT_LE((forward_kinematics(master(), q).translation() - p).norm(), 1e-15);
  }
}

TEST(MasterManipulator, TheFirstBranchIsThePapersPositionFormula) {
  SCOPED_TRACE("seed 4");
  std::mt19937 random{4};
  for (int n = 0; n < 1000; ++n) {
    JointVector q(6);
    for (int i = 0; i < 6; ++i) {
      q[i] = std::uniform_real_distribution{master().lower()[i], master().upper()[i]}(random);
    }
    const Eigen::Isometry3d pose = forward_kinematics(master(), q);
    const Eigen::Vector3d p = pose.translation();
    const JointVector found = solve(pose).branch[0].q;
    ASSERT_NEAR(found[0], std::atan2(p.x(), p.z()), 1e-14);
    ASSERT_NEAR(found[1], std::atan2(std::hypot(p.x(), p.z()), p.y()), 1e-14);
    ASSERT_NEAR(found[2], p.norm() - 0.02, 1e-15);
  }
}

TEST(MasterManipulator, AtTheStartWithJoint1AtZeroTheHandIsNotTurned) {
  JointVector q = joints(reference()["trajectory"]["qA"]);
  q[0] = 0;
  EXPECT_LE((forward_kinematics(master(), q).linear() - Eigen::Matrix3d::Identity()).norm(), 2e-5);
}

TEST(MasterManipulator, EveryReferencePoseHasItsMatrixAndItsFourBranches) {
  const Figures poses = reference()["poses"];
  ASSERT_EQ(poses.size(), 5u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    SCOPED_TRACE(i);
    const Eigen::Isometry3d pose = forward_kinematics(master(), joints(poses[i]["q"]));
    expect_matrix(pose, poses[i]["T"]);
    expect_branches(pose, poses[i]["ik"]);
  }
}

TEST(MasterManipulator, BothEndsOfTheMotionComeBackWithAllBranches) {
  const Figures motion = reference()["trajectory"];
  for (const std::string end : {"A", "B"}) {
    SCOPED_TRACE(end);
    const Eigen::Isometry3d pose = forward_kinematics(master(), joints(motion["q" + end]));
    expect_matrix(pose, motion["T_" + end]);
    expect_branches(pose, motion["ik_" + end]);
  }
}

/// The paper's motion: rest to rest in 5 s, by the quintic trajectory plugin, within our limits.
class MasterMotion : public ::testing::Test {
 protected:
  static Trajectory planned() {
    const auto planner =
        std::move(built_plugins()
                      .make<TrajectoryPlanner>("trajectory/quintic", defaults("trajectory/quintic"))
                      .value());
    const Figures motion = reference()["trajectory"];
    const JointVector a = joints(motion["qA"]), b = joints(motion["qB"]),
                      zero = JointVector::Zero(6);
    return planner
        ->plan({.goal_id = 1,
                .start = {},
                .from = {a, zero, zero},
                .segments = {{{0, 1}, {a, b}, true, motion["T"].number()}},
                .max_velocity = master().max_velocity(),
                .max_acceleration = master().max_acceleration()})
        .value();
  }
  JointState at(double t) const { return trajectory_.at(trajectory_.start + seconds(t)); }

  const Figures motion_ = reference()["trajectory"];
  const Trajectory trajectory_ = planned();
};

TEST_F(MasterMotion, HasEverySampleOfTheReference) {
  const Figures samples = motion_["samples"];
  ASSERT_EQ(samples.size(), 11u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const JointState s = at(samples[i]["t"].number());
    SCOPED_TRACE(samples[i]["t"].number());
    EXPECT_LE((s.q - joints(samples[i]["q"])).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LE((s.v - joints(samples[i]["qd"])).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LE((s.a - joints(samples[i]["qdd"])).cwiseAbs().maxCoeff(), 1e-11);
    const Eigen::Vector3d tip = forward_kinematics(master(), s.q).translation();
    EXPECT_LE((tip - samples[i]["p"].point_m()).norm(), 1e-12);
  }
}

TEST_F(MasterMotion, KeepsTheFirstBranchWithinTheLimitsAllTheWay) {
  for (int i = 0; i <= 500; ++i) {
    const JointVector q = at(0.01 * i).q;
    const IkBranches found = solve(forward_kinematics(master(), q));
    ASSERT_EQ(found.count, 4);
    double nearest = 10;
    for (const IkBranch& branch : found) {
      if (branch.within_limits) nearest = std::min(nearest, difference(branch.q, q));
    }
    ASSERT_LE(nearest, 1e-12) << q.transpose();
  }
}

}  // namespace
}  // namespace armature::paper
