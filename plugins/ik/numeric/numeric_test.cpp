// SPDX-License-Identifier: Apache-2.0
#include "numeric.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/kinds/ik/contract.hpp"
#include "armature/kinds/ik/test_goals.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik::numeric {
namespace {

using Row = std::array<double, 4>;  // d, a [m], alpha [deg], limit [deg]

RobotModel arm(std::string name, const std::vector<Row>& rows,
               RobotModel::Convention convention = RobotModel::Convention::standard) {
  std::vector<Joint> joints;
  for (const auto& [d, a, alpha, limit] : rows) {
    const double radians = M_PI / 180;
    joints.push_back({.name = "j" + std::to_string(joints.size() + 1),
                      .d = d,
                      .a = a,
                      .alpha = alpha * radians,
                      .lower = -limit * radians,
                      .upper = limit * radians,
                      .max_velocity = 1,
                      .max_acceleration = 1});
  }
  const int last = static_cast<int>(joints.size()) - 1;
  return {{std::move(name),
           convention,
           std::move(joints),
           {{"tool", last, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

/// PUMA 560.
RobotModel puma() {
  return arm("puma", {{0, 0, 90, 160},
                      {0, 0.4318, 0, 125},
                      {0.15005, 0.0203, -90, 135},
                      {0.4318, 0, 90, 140},
                      {0, 0, -90, 100},
                      {0.056, 0, 0, 180}});
}
/// Seven joints, shoulder and wrist spherical.
RobotModel seven() {
  return arm("seven", {{0.34, 0, -90, 170},
                       {0, 0, 90, 120},
                       {0.4, 0, 90, 170},
                       {0, 0, -90, 120},
                       {0.4, 0, -90, 170},
                       {0, 0, 90, 120},
                       {0.126, 0, 0, 175}});
}
/// A slide, four turns and a wrist that turns with the second joint, pointing with its z.
RobotModel gantry() {
  RobotModel base = arm("gantry", {{0, 0, -90, 0},
                                   {0.1, 0.4, 0, 150},
                                   {0, 0.3, 90, 150},
                                   {0.1, 0, -90, 170},
                                   {0, 0.1, 90, 120},
                                   {0.1, 0.05, 30, 90}});
  auto joints = base.joints();
  joints[0].type = Joint::Type::prismatic;
  joints[0].lower = 0.2, joints[0].upper = 0.8;
  joints[5].coupling = Joint::Coupling{.to = 1, .ratio = 0.5, .offset = 0.1};
  return {{"gantry",
           RobotModel::Convention::modified,
           joints,
           {{"tool", 5, Eigen::Isometry3d{Eigen::Translation3d{0, 0, 0.1}}}},
           FrameId{0},
           Eigen::Vector3d{0, 0.6, 0.8},
           {}}};
}
/// Seven joints, two of them elbows: stretched, the rim hardly bends along the turn of the nearly
/// straight wrist within itself.
RobotModel two_elbows() {
  return arm("two_elbows",
             {{0.3, 0, 0, 170},
              {0, 0.05, -90, 150},
              {0, 0.35, 0, 120},
              {0, 0.1, 0, 150},
              {0.3, 0, -90, 170},
              {0, 0, 90, 120},
              {0.08, 0, -90, 170}},
             RobotModel::Convention::modified);
}
/// Six joints, and a pointing axis that is askew to the last: the rim bends far more along one
/// motion of the stretched arm than along another.
RobotModel askew() {
  const RobotModel base = arm("askew",
                              {{0.4, 0, 0, 166},
                               {0, 0.1, -90, 180},
                               {0, 0.4, 0, 143},
                               {0.35, 0.05, -90, 180},
                               {0, 0, 90, 115},
                               {0.1, 0, -90, 180}},
                              RobotModel::Convention::modified);
  const Eigen::Isometry3d tool =
      Eigen::Translation3d{0, -0.01, 0.15} * Eigen::AngleAxisd{0.3, Eigen::Vector3d::UnitX()};
  return {{"askew",
           base.convention(),
           base.joints(),
           {{"tool", 5, tool}},
           FrameId{0},
           Eigen::Vector3d::UnitZ(),
           {}}};
}
/// Seven joints, with limits to one side and flexed elbow and wrist beside the axes (Franka Panda).
RobotModel panda() {
  const RobotModel base = arm("panda",
                              {{0.333, 0, 0, 166},
                               {0, 0, -90, 101},
                               {0.316, 0, 90, 166},
                               {0, 0.0825, 90, 0},
                               {0.384, -0.0825, -90, 166},
                               {0, 0, 90, 0},
                               {0.107, 0.088, 90, 166}},
                              RobotModel::Convention::modified);
  auto joints = base.joints();
  joints[3].lower = -3.0718, joints[3].upper = -0.0698;
  joints[5].lower = -0.0175, joints[5].upper = 3.7525;
  return {{"panda",
           base.convention(),
           joints,
           {{"tool", 6, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           std::nullopt,
           {}}};
}
/// Seven joints, of which four have limits more than a whole turn apart, and a wrist whose axes
/// just miss each other (after the Kinova Gen3).
RobotModel gen3() {
  return arm("gen3",
             {{0.2848, 0, 0, 360},
              {-0.0118, 0, -90, 128},
              {0.4208, 0, 90, 360},
              {-0.0128, 0, -90, 147},
              {0.3143, 0, 90, 360},
              {-0.0002, 0, -90, 120},
              {0.1674, 0, 90, 360}},
             RobotModel::Convention::modified);
}
RobotModel lamp() {
  return load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
}

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model,
                                           const Parameters& parameters = {}) {
  return std::make_shared<Numeric>(model, parameters);
}

IkLawCase on(std::string name, RobotModel (*model)()) {
  return {std::move(name), [model] {
            const auto made = std::make_shared<const RobotModel>(model());
            return IkSubject{.model = made, .solver = solver_for(*made), .poses = 1000, .seed = 2};
          }};
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(Numeric, IkLaws,
                         testing::Values(on("puma", &puma), on("seven", &seven),
                                         on("gantry", &gantry), on("two_elbows", &two_elbows),
                                         on("askew", &askew), on("panda", &panda),
                                         on("gen3", &gen3)),
                         testing::PrintToStringParamName());

TEST(Numeric, TheSolutionNextToTheSeedIsFoundFromTheSeed) {
  const RobotModel model = puma();
  const JointVector q = Eigen::Matrix<double, 6, 1>{0.3, -0.6, 0.9, 0.4, 0.7, -0.2};
  IkBranches found;
  IkState state;
  ASSERT_EQ(solver_for(model)->solve(test::goal_at(model, q), q.array() + 0.05, found, state).code,
            IkStatus::Code::ok);
  ASSERT_EQ(found.count, 1);
  EXPECT_EQ(found.begin()->label, "from_seed");
  EXPECT_LE((found.begin()->q - q).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Numeric, ASeedThatIsTheSolutionStaysWhereItIsEvenAtASingularPose) {
  const RobotModel model = lamp();
  const JointVector stretched = JointVector::Zero(5);
  IkGoal goal;
  goal.pose = {{1.69, 0, 0.50407}, Direction{{1, 0, 0}}};
  IkBranches found;
  IkState state;
  ASSERT_EQ(solver_for(model)->solve(goal, stretched, found, state).code, IkStatus::Code::ok);
  EXPECT_LE(found.begin()->q.norm(), 1e-9);
  EXPECT_TRUE(found.begin()->singular);
}

TEST(Numeric, AGoalThatOnlySolutionsBeyondTheLimitsReachIsAJointLimit) {
  RobotModel wide = puma();
  auto joints = wide.joints();
  joints[0].lower = -0.1, joints[0].upper = 0.1;
  const RobotModel narrow{
      {"narrow", wide.convention(), joints, wide.frames(), wide.tool(), {}, {}}};
  const JointVector q = Eigen::Matrix<double, 6, 1>{1.2, -0.6, 0.9, 0.4, 0.7, -0.2};
  IkBranches found;
  IkState state;
  const IkStatus status = solver_for(narrow)->solve(test::goal_at(narrow, q), q, found, state);
  EXPECT_EQ(status.code, IkStatus::Code::joint_limit) << describe(status);
  EXPECT_GE(found.count, 1);
  for (const IkBranch& branch : found) EXPECT_FALSE(branch.within_limits);
}

TEST(Numeric, ARedundantArmIsBroughtInsideItsLimitsWithoutARestart) {
  const RobotModel model = seven();
  const auto solver = solver_for(model, {.max_restarts = 0});
  std::mt19937_64 random{9};
  SCOPED_TRACE("seed 9");
  const auto within_limits = [&] {
    JointVector q(model.dof());
    for (int i = 0; i < model.dof(); ++i) {
      q[i] = std::uniform_real_distribution{model.lower()[i], model.upper()[i]}(random);
    }
    return q;
  };
  int at_a_limit = 0;
  for (int k = 0; k < 2000; ++k) {
    IkBranches found;
    IkState state;
    const JointVector q = within_limits();
    if (solver->solve(test::goal_at(model, q), within_limits(), found, state).code !=
        IkStatus::Code::ok) {
      continue;
    }
    const IkBranch& branch = *found.begin();
    const double spare =
        (branch.q - model.lower()).cwiseMin(model.upper() - branch.q).cwiseAbs().minCoeff();
    if (spare > 1e-12) continue;
    ++at_a_limit;
    EXPECT_LE(
        residual(forward_kinematics(model, branch.q), {}, test::goal_at(model, q).pose).position_m,
        1e-9);
    EXPECT_EQ(branch.singular, manipulability(model, branch.q) < 1e-6);
  }
  EXPECT_GE(at_a_limit, 100);
}

TEST(Numeric, WithoutRestartsAnUnreachableGoalEndsWithItsResidual) {
  const RobotModel model = lamp();
  IkGoal goal;
  goal.pose = {{0.5, 0, 1.3}, Direction{{1, 0, 0}}};  // 0.2 m too high for the balance arm
  IkBranches found;
  IkState state;
  const IkStatus status = solver_for(model, {.max_restarts = 0})
                              ->solve(goal, JointVector::Constant(5, 0.3), found, state);
  EXPECT_EQ(status.code, IkStatus::Code::no_convergence);
  EXPECT_GE(status.shortfall, 0.02);
  EXPECT_LE(status.shortfall, 0.5);
}

TEST(Numeric, TheIterationBudgetOfTheGoalIsKept) {
  const RobotModel model = puma();
  IkGoal goal = test::goal_at(model, Eigen::Matrix<double, 6, 1>{1.3, -0.6, 0.9, 0.4, 0.7, -0.2});
  goal.max_iterations = 1;
  IkBranches found;
  IkState state;
  EXPECT_EQ(solver_for(model)->solve(goal, JointVector::Zero(6), found, state).code,
            IkStatus::Code::no_convergence);
}

}  // namespace
}  // namespace armature::ik::numeric
