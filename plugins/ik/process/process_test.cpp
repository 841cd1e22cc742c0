// SPDX-License-Identifier: Apache-2.0
// `armature ik` as the program: the solver behind it keeps its laws, and its answers come through.
#include "process.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/ik/contract/law.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature::ik::process {
namespace {

std::shared_ptr<const RobotModel> robot(const std::string& name) {
  return std::make_shared<const RobotModel>(
      load_robot_model(fmt::format("{}/configs/robots/{}.yaml", ARMATURE_SOURCE_DIR, name)));
}

std::shared_ptr<const IkSolver> made(const RobotModel& model, const std::string& params) {
  const auto given = declared_params(ARMATURE_SOURCE_DIR "/plugins/ik/process/plugin.yaml",
                                     "{" + params + ", start_timeout_s: 60, timeout_s: 60}");
  return std::move(Process::make(model, given).value());
}

/// `armature ik` with another plugin.
std::shared_ptr<const IkSolver> relay(const RobotModel& model, const std::string& plugin) {
  return made(model, fmt::format("command: [{}/bin/armature, ik, --robot, "
                                 "{}/configs/robots/{}.yaml, --plugin, {}]",
                                 ARMATURE_BINARY_DIR, ARMATURE_SOURCE_DIR, model.name(), plugin));
}

/// Every law, with a solver of which it is known that it keeps them. The allocations are not
/// counted.
void expect_laws_kept(const std::string& plugin, bool closed_form) {
  IkSubject tried;
  tried.model = robot("dental_lamp");
  tried.solver = relay(*tried.model, plugin);
  tried.closed_form = tried.any_seed_at_edges = closed_form;
  tried.allocates = true;
  tried.poses = 200;
  tried.edge_poses = 50;
  for (const IkLaw& law : ik_laws()) {
    SCOPED_TRACE(law.name);
    const LawReport report = check_law(law, tried);
    EXPECT_EQ(report.failed, 0) << "of " << report.questions << " questions, seed " << tried.seed;
    for (const auto& [what, question] : report.violations) {
      ADD_FAILURE() << what << "\n" << question;
    }
  }
}

TEST(Relay, KeepsTheLawsOfASolverThatKnowsEveryBranch) {
  expect_laws_kept("ik/lamp_geometric", true);
}

TEST(Relay, KeepsTheLawsOfASolverThatStartsAnywhere) { expect_laws_kept("ik/numeric", false); }

/// Reachable goals and others, some with a wanted redundancy.
IkGoal random_goal(const RobotModel& model, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit{-1, 1};
  JointVector q(model.dof());
  for (int i = 0; i < q.size(); ++i) {
    q[i] = std::uniform_real_distribution{model.lower()[i], model.upper()[i]}(random);
  }
  const Eigen::Isometry3d pose = forward_kinematics(model, q);
  IkGoal goal;
  goal.pose.position = pose.translation();
  if (unit(random) > 0.7) goal.pose.position *= 1.5;
  if (model.pointing_axis()) {
    goal.pose.orientation = Direction{(pose.linear() * *model.pointing_axis()).normalized()};
  } else {
    goal.pose.orientation = Eigen::Quaterniond{pose.linear()}.normalized();
  }
  return goal;
}

/// Asked directly and through the program, every answer is the same: bit for bit, but for
/// residuals, which are worked out here again.
void expect_same_answers(const std::string& robot_name, const std::string& plugin) {
  SCOPED_TRACE(robot_name + ", " + plugin + ", seed 61");
  const auto model = robot(robot_name);
  PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
  const auto given =
      declared_params(fmt::format("{}/plugins/{}/plugin.yaml", ARMATURE_SOURCE_DIR, plugin), "");
  const auto direct = plugins.make<IkSolver>(plugin, *model, given);
  ASSERT_TRUE(direct) << direct.error().text;
  const auto relayed = relay(*model, plugin);
  std::mt19937_64 random{61};
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
    IkGoal goal = random_goal(*model, random);
    const JointVector seed = resting_position(*model);
    if (i % 3 == 0) goal.max_iterations = 1 + i / 30;
    IkBranches wanted, found;
    IkState state;
    if (i % 2 == 0) state.last_redundancy = 0.01 * i;
    IkState other_state = state;
    const IkStatus told = (*direct)->solve(goal, seed, wanted, state);
    const IkStatus status = relayed->solve(goal, seed, found, other_state);
    ASSERT_EQ(describe(status), describe(told));
    EXPECT_EQ(status.shortfall, told.shortfall);
    EXPECT_EQ(other_state.last_redundancy, state.last_redundancy);
    ASSERT_EQ(found.count, wanted.count);
    for (int b = 0; b < found.count; ++b) {
      const IkBranch &a = found.branch[static_cast<std::size_t>(b)],
                     &w = wanted.branch[static_cast<std::size_t>(b)];
      EXPECT_EQ(a.label, w.label);
      EXPECT_EQ(a.q, w.q);
      EXPECT_EQ(a.within_limits, w.within_limits);
      EXPECT_NEAR(a.residual.position_m, w.residual.position_m, 1e-12);
      EXPECT_NEAR(a.residual.angle_rad, w.residual.angle_rad, 1e-12);
    }
    solved += status.code == IkStatus::Code::ok;
  }
  EXPECT_GT(solved, 100);
}

TEST(Relay, GivesTheAnswersOfTheSolverBehindIt) {
  expect_same_answers("dental_lamp", "ik/numeric");
  expect_same_answers("dental_lamp", "ik/lamp_geometric");
  expect_same_answers("sr1", "ik/numeric");
  expect_same_answers("med7", "ik/srs_arm_angle");
}

TEST(PythonExample, SolvesTheLampFromNearbySeeds) {
  const auto model = robot("dental_lamp");
  const auto solver = made(*model, "command: [./lamp_dls.py], folder: " ARMATURE_SOURCE_DIR
                                   "/plugins/ik/process/example");
  SCOPED_TRACE("seed 62");
  std::mt19937_64 random{62};
  std::uniform_real_distribution<double> nearby{-0.2, 0.2};
  int solved = 0;
  for (int i = 0; i < 60; ++i) {
    JointVector q = resting_position(*model), seed = q;
    for (int j = 0; j < q.size(); ++j) q[j] += 2 * nearby(random), seed[j] = q[j] + nearby(random);
    const Eigen::Isometry3d pose = forward_kinematics(*model, q);
    IkGoal goal;
    goal.pose = {pose.translation(), Direction{pose.linear().col(0).normalized()}};
    IkBranches found;
    IkState state;
    const IkStatus status = solver->solve(goal, seed, found, state);
    if (status.code != IkStatus::Code::ok && status.code != IkStatus::Code::joint_limit) {
      EXPECT_EQ(status.code, IkStatus::Code::no_convergence) << describe(status);
      continue;
    }
    ++solved;
    ASSERT_EQ(found.count, 1);
    EXPECT_EQ(found.branch[0].label, "from_seed");
    EXPECT_LE(found.branch[0].residual.position_m, 1e-9);
    EXPECT_LE(found.branch[0].residual.angle_rad, 1e-9);
  }
  EXPECT_GE(solved, 55);
}

TEST(PythonExample, RefusesARobotThatItDoesNotKnowInItsOwnWords) {
  const auto model = robot("sr1");
  const auto given =
      declared_params(ARMATURE_SOURCE_DIR "/plugins/ik/process/plugin.yaml",
                      "{command: [./lamp_dls.py], start_timeout_s: 60, folder: " ARMATURE_SOURCE_DIR
                      "/plugins/ik/process/example}");
  EXPECT_EQ(Process::make(*model, given).error().text,
            "the program './lamp_dls.py' does not accept the robot's resting position as a goal: "
            "this solver knows directions, not rotations");
}

TEST(PythonExample, SaysWhatItDoesNotKnowInItsOwnWords) {
  const auto model = robot("dental_lamp");
  const auto solver =
      made(*model, "command: [python3, example/lamp_dls.py], folder: " ARMATURE_SOURCE_DIR
                   "/plugins/ik/process");
  IkGoal goal;
  goal.pose.orientation = Eigen::Quaterniond::Identity();
  IkBranches found;
  IkState state;
  EXPECT_EQ(describe(solver->solve(goal, resting_position(*model), found, state)),
            "invalid_input: this solver knows directions, not rotations");
}

TEST(Process, AnswersBadInputItself) {
  const auto model = robot("dental_lamp");
  const auto solver = relay(*model, "ik/lamp_geometric");
  IkGoal goal;
  goal.pose.position.x() = NAN;
  IkBranches found;
  IkState state;
  EXPECT_EQ(describe(solver->solve(goal, resting_position(*model), found, state)),
            "invalid_input: the position is not finite");
}

}  // namespace
}  // namespace armature::ik::process
