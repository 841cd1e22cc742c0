// SPDX-License-Identifier: Apache-2.0
#include "lamp_geometric.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/kinds/ik/contract.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

std::shared_ptr<const RobotModel> lamp() {
  static const auto model = std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml"));
  return model;
}

/// The lamp with some joints changed.
template <class Change>
RobotModel changed_lamp(Change change) {
  RobotParts parts = lamp()->parts();
  parts.name = "changed";
  parts.home.reset();
  change(parts.joints, parts.frames);
  return parts;
}

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model) {
  return std::move(LampGeometric::make(model, Params{}).value());
}

IkSubject subject(std::shared_ptr<const RobotModel> model) {
  return {.model = model, .solver = solver_for(*model), .closed_form = true};
}

/// Other lengths, all signs that the table allows, and joints that turn all the way round.
std::shared_ptr<const RobotModel> another_lamp() {
  return std::make_shared<const RobotModel>(changed_lamp([](auto& joints, auto&) {
    const std::array<double, 6> a{0.4, 0, 0.7, -0.1, 0.15, -0.05};
    for (std::size_t i = 0; i < 6; ++i) {
      joints[i].a = a[i];
      joints[i].lower = -M_PI;
      joints[i].upper = M_PI;
    }
    joints[4].d = 0.3;
  }));
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(AnotherLamp, IkLaws,
                         testing::Values(IkLawCase{"other_lengths",
                                                   [] { return subject(another_lamp()); }}),
                         testing::PrintToStringParamName());

class LampGeometricTest : public testing::Test {
 protected:
  IkStatus solve(const Eigen::Vector3d& position, const Eigen::Vector3d& direction,
                 const JointVector& seed = JointVector::Zero(5)) {
    IkGoal goal;
    goal.pose = {position, Direction{direction}};
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }
  std::shared_ptr<const IkSolver> solver_ = solver_for(*lamp());
  IkBranches found_;
};

JointVector joints(std::array<double, 5> q) {
  return Eigen::Map<const Eigen::Matrix<double, 5, 1>>(q.data());
}

TEST_F(LampGeometricTest, BranchesComeInAFixedOrderWithTheirNames) {
  ASSERT_EQ(
      solve({0.2770122, 0.2310073, 0.6954166}, {-0.946822657, -0.286421675, -0.146592906}).code,
      IkStatus::Code::ok);
  ASSERT_EQ(found_.count, 8);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(found_.branch[static_cast<std::size_t>(i)].label,
              "tilt" + std::to_string(i / 4) + "/balance" + std::to_string(i / 2 % 2) + "/elbow" +
                  std::to_string(i % 2));
  }
}

TEST_F(LampGeometricTest, AFullyStretchedArmIsADoubleRootAndSingular) {
  EXPECT_EQ(solve({1.69, 0, 0.50407}, {1, 0, 0}).code, IkStatus::Code::ok);
  ASSERT_EQ(found_.count, 2);
  for (const IkBranch& branch : found_) {
    EXPECT_LE(branch.q.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_TRUE(branch.singular);
  }
}

TEST_F(LampGeometricTest, AMicrometreBeyondReachIsUnreachableByAMicrometre) {
  const IkStatus status = solve({1.690001, 0, 0.50407}, {1, 0, 0});
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall, 1e-6, 1e-12);
  EXPECT_EQ(describe(status), "out_of_reach: 1e-06 m beyond reach (horizontal distance)");
}

TEST_F(LampGeometricTest, TooHighSaysByHowMuch) {
  const IkStatus status = solve({1.0, 0, 1.2}, {1, 0, 0});
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall, 1.2 - 0.50407 - 0.6, 1e-12);
  EXPECT_EQ(status.detail, "height");
}

TEST_F(LampGeometricTest, PointingStraightDownKeepsTheSeedsHeading) {
  const JointVector seed = joints({0.4, -0.9, 0.1, 0.8, -1.2});
  ASSERT_EQ(solve({1.2, 0.2, 0.42407}, {0, 0, -1}, seed).code, IkStatus::Code::joint_limit);
  ASSERT_EQ(found_.count, 2);  // both tilts are one
  for (const IkBranch& branch : found_) {
    EXPECT_NEAR(branch.q[0] + branch.q[1] + branch.q[3], 0.4 - 0.9 + 0.8, 1e-12);
    EXPECT_TRUE(branch.singular);
    EXPECT_LE(branch.residual.position_m, 1e-12);
  }
}

TEST_F(LampGeometricTest, PointingStraightDownTurnsAHeadingThatCannotReachToTheNearestThatCan) {
  const JointVector seed = joints({3.0, 0, 0, 0, 0});  // away from the goal: 1.6 m + 0.2 m
  EXPECT_EQ(solve({1.6, 0, 0.42407}, {0, 0, -1}, seed).code, IkStatus::Code::joint_limit);
  ASSERT_EQ(found_.count, 2);
  for (const IkBranch& branch : found_) EXPECT_LE(branch.residual.position_m, 1e-12);
  const double heading = found_.branch[0].q[0] + found_.branch[0].q[1] + found_.branch[0].q[3];
  EXPECT_NEAR(std::abs(wrap_angle(heading)), std::acos((1.6 * 1.6 + 0.04 - 1.41 * 1.41) / 0.64),
              1e-9);
}

TEST_F(LampGeometricTest, StretchedUpTheBalanceArmIsSingular) {
  const JointVector up = joints({0.3, -1.0, M_PI / 2, 0.2, 0.1});
  const auto pose = forward_kinematics(*lamp(), up);
  solve(pose.translation(), pose.linear().col(0));
  ASSERT_GE(found_.count, 2);
  for (const IkBranch& branch : found_) EXPECT_TRUE(branch.singular) << branch.label;
}

TEST_F(LampGeometricTest, AnArmFoldedOntoItsColumnKeepsTheSeedsFirstJoint) {
  const RobotModel model =
      changed_lamp([](auto& rows, auto&) { rows[0].a = 0.8; });  // a1 = a3 + a4
  const auto solver = solver_for(model);
  const JointVector folded = joints({0.7, -M_PI, 0, 0.4, 0.2});
  const auto pose = forward_kinematics(model, folded);
  IkGoal goal;
  goal.pose = {pose.translation(), Direction{pose.linear().col(0)}};
  IkState state;
  solver->solve(goal, joints({0.7, 0, 0, 0, 0}), found_, state);
  ASSERT_GE(found_.count, 2);
  EXPECT_NEAR(found_.branch[0].q[0], 0.7, 1e-9);
  EXPECT_TRUE(found_.branch[0].singular);
  EXPECT_LE(found_.branch[0].residual.position_m, 1e-9);
}

TEST_F(LampGeometricTest, ARotationIsReachedOnlyWithoutRoll) {
  const JointVector q = joints({0.5, -1.2, 0.3, 0.9, -0.4});
  const auto pose = forward_kinematics(*lamp(), q);
  IkGoal goal;
  IkState state;
  goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
  EXPECT_EQ(solver_->solve(goal, q, found_, state).code, IkStatus::Code::ok);
  EXPECT_EQ(found_.begin()->label, "tilt0/balance0/elbow0");
  EXPECT_LE((found_.begin()->q - q).cwiseAbs().maxCoeff(), 1e-9);
  goal.pose.orientation =
      Eigen::Quaterniond{pose.linear() * Eigen::AngleAxisd{0.1, Eigen::Vector3d::UnitX()}};
  const IkStatus status = solver_->solve(goal, q, found_, state);
  EXPECT_EQ(describe(status), "out_of_reach: the lamp cannot roll about its pointing axis");
}

/// Why the solver refuses a lamp with some rows changed.
template <class Change>
std::string refusal(Change change) {
  const auto made = LampGeometric::make(changed_lamp(change), Params{});
  return made ? "" : made.error().text;
}

TEST(LampStructure, TheFirstMismatchIsNamed) {
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[1].alpha = -M_PI / 2; }),
            "not a lamp arm: joint 'j2': alpha_deg must be 90, it is -90");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[2].d = 0.02; }),
            "not a lamp arm: joint 'j3': d_m must be 0, it is 0.02");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[3].coupling->ratio = 1; }),
            "not a lamp arm: joint 'j4' must be coupled to the one before with ratio -1");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[3].coupling.reset(); }),
            "not a lamp arm: joint 'j4' is not coupled to the one before");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[4].type = Joint::Type::prismatic; }),
            "not a lamp arm: joint 'j5' is not revolute");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows.push_back(rows[5]); }),
            "not a lamp arm: 6 joints needed, 'changed' has 7");
  EXPECT_EQ(refusal([](auto&, auto& frames) {
              for (auto& frame : frames) frame.parent_T_frame.translation().x() = 0.1;
            }),
            "not a lamp arm: its tool must be the frame of joint 'j6'");
}

TEST(LampStructure, ALockedJointIsRefused) {
  RobotParts parts = lamp()->parts();
  parts.joints[4].locked = true;
  EXPECT_EQ(LampGeometric::make(RobotModel{parts}, Params{}).error().text,
            "not a lamp arm: joint 'j5' is locked");
}

TEST(LampGeometricRandom, EveryPoseHasAnEvenNumberOfBranches) {
  const auto model = another_lamp();
  SCOPED_TRACE("seed 7");
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> angle{-M_PI, M_PI};
  const auto solver = solver_for(*model);
  for (int i = 0; i < 20000; ++i) {
    JointVector q(5);
    for (double& value : q) value = angle(random);
    const auto pose = forward_kinematics(*model, q);
    IkGoal goal;
    goal.pose = {pose.translation(), Direction{pose.linear().col(0)}};
    IkBranches found;
    IkState state;
    solver->solve(goal, q, found, state);
    ASSERT_EQ(found.count % 2, 0);
    ASSERT_GE(found.count, 2);
  }
}

}  // namespace
}  // namespace armature
