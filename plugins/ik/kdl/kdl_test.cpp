// SPDX-License-Identifier: Apache-2.0
// The plugin as it is found: its laws on arms that it serves, and what it refuses. All robots of
// configs/robots are met in tests/contracts.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/kinds/ik/contract.hpp"
#include "armature/kinds/ik/test_goals.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::ik::kdl {
namespace {

using ModelPtr = std::shared_ptr<const RobotModel>;

Expected<IkSubject> kdl(const ModelPtr& model, const std::string& method) {
  const PluginManifest& plugin = *built_plugins().find("ik/kdl");
  config::Problems problems;
  const auto given = config::parse_text("{method: " + method + "}", "test");
  const Params params = Params::read(plugin.params, &given, plugin.id, problems);
  problems.throw_if_any();
  return plugin_subject(built_plugins(), plugin, model, params);
}

ModelPtr robot(const std::string& name) {
  return std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/" + name + ".yaml"));
}
ModelPtr skew_puma() {
  return std::make_shared<const RobotModel>(load_urdf_robot(
      ARMATURE_SOURCE_DIR "/tests/data/urdf/skew_puma.urdf", {"", {}}, {"tool0", {}}));
}

IkLawCase on(std::string name, std::function<ModelPtr()> model, std::string method) {
  return {std::move(name), [model = std::move(model), method = std::move(method)] {
            IkSubject made = kdl(model(), method).value();
            made.poses = made.edge_poses = 100;
            return made;
          }};
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(Kdl, IkLaws,
                         ::testing::Values(on(
                             "sr1_nr_jl", [] { return robot("sr1"); }, "nr_jl")),
                         ::testing::PrintToStringParamName());

std::string refusal(const RobotModel& model) {
  const auto made = kdl(std::make_shared<const RobotModel>(model), "lma");
  return made ? "" : made.error().text;
}

TEST(KdlRefuses, CoupledJointsDirectionsAndJointsBehindTheTool) {
  EXPECT_EQ(refusal(testing::synthetic_robot(RobotModel::Convention::standard, 1)),
            "KDL knows no coupled joints");
  EXPECT_EQ(refusal(*robot("sr1_needle")), "KDL solves for rotations, not for directions");
  const ModelPtr sr1 = robot("sr1");
  const RobotModel short_of{{sr1->name(),
                             sr1->convention(),
                             sr1->joints(),
                             {{"tool", 4, Eigen::Isometry3d::Identity()}},
                             FrameId{0},
                             std::nullopt,
                             std::nullopt}};
  EXPECT_EQ(refusal(short_of), "its tool must hang on the last joint");
}

TEST(Kdl, RefusesARedundancyThatItWouldNotHold) {
  const ModelPtr model = robot("med7");
  const IkSubject made = kdl(model, "lma").value();
  IkGoal goal = test::goal_at(*model, *model->home());
  IkBranches found;
  IkState state;
  EXPECT_EQ(made.solver->solve(goal, *model->home(), found, state).code, IkStatus::Code::ok);
  goal.redundancy = 0.3;
  const IkStatus status = made.solver->solve(goal, *model->home(), found, state);
  EXPECT_EQ(describe(status), "invalid_input: KDL holds no redundancy; leave it out");
  EXPECT_EQ(found.count, 0);
}

TEST(Kdl, SolvesForEveryToleranceThatIsAskedFor) {
  const ModelPtr model = skew_puma();
  std::mt19937 random{3};
  for (const std::string method : {"lma", "nr_jl"}) {
    const IkSubject made = kdl(model, method).value();
    int reached = 0;
    for (int i = 0; i < 300; ++i) {
      const JointVector q = testing::random_joints(*model, random);
      IkGoal goal = test::goal_at(*model, q);
      goal.tolerance = {.position_m = i % 2 == 0 ? 1e-3 : 1e-8, .angle_rad = 1e-7};
      IkBranches found;
      IkState state;
      const JointVector seed = q + JointVector::Constant(6, 0.05);
      if (made.solver->solve(goal, seed, found, state).code == IkStatus::Code::ok) ++reached;
      for (const IkBranch& branch : found) {
        EXPECT_LE(branch.residual.position_m, goal.tolerance.position_m);
        EXPECT_LE(branch.residual.angle_rad, goal.tolerance.angle_rad);
      }
    }
    EXPECT_GT(reached, 270) << method << ", seed 3";
  }
}

}  // namespace
}  // namespace armature::ik::kdl
