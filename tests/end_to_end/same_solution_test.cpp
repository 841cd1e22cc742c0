// SPDX-License-Identifier: Apache-2.0
// Two solvers that share no code, asked for every goal that the default run solved.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "recording.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

constexpr double kAgree = 1e-6;       // [rad] and [m]
constexpr double kClosedForm = 1e-9;  // [rad] and [m], residual of the closed form

struct Question {
  PlannedPose pose;
  Eigen::VectorXd seed, chosen;
};

/// What the motion component asked for: every pose of a path, seeded with the solution before it.
std::vector<Question> questions_of(const Recording& recording) {
  std::vector<Question> questions;
  for (const auto& [goal, path] : recording.path) {
    const auto& joints = recording.joint_path.at(goal);
    // The joint path begins with the start, which is the first pose of a path that begins there.
    const std::size_t offset = joints.size() - path.size();
    EXPECT_LE(offset, 1U) << "goal " << goal;
    for (std::size_t i = 1 - offset; i < path.size(); ++i) {
      questions.push_back({path[i], joints[i + offset - 1], joints[i + offset]});
    }
    questions.push_back({path.back(), joints.front(), joints.back()});
  }
  return questions;
}

std::vector<double> numbers(const auto& vector) { return {vector.begin(), vector.end()}; }

/// Every answer of a solver, in the order of the questions.
std::vector<json> ask(const std::string& plugin, const std::vector<Question>& questions) {
  std::string lines;
  for (const Question& question : questions) {
    lines += json{{"position_m", numbers(question.pose.position)},
                  {"direction", numbers(question.pose.direction)},
                  {"seed", numbers(question.seed)}}
                 .dump() +
             "\n";
  }
  const CommandResult result =
      run_command({armature(), "ik", "--robot", source_file("configs/robots/dental_lamp.yaml"),
                   "--plugin", plugin},
                  {.environment = {}, .input = lines});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<json> answers;
  std::istringstream out{result.out};
  for (std::string line; std::getline(out, line);) answers.push_back(json::parse(line));
  return answers;
}

/// The solution nearest to the seed; an infinite vector when there is none.
Eigen::VectorXd nearest(const json& answer, const Eigen::VectorXd& seed, double residual) {
  Eigen::VectorXd best = Eigen::VectorXd::Constant(seed.size(), INFINITY);
  for (const json& solution : answer["solutions"]) {
    if (!solution["within_limits"].get<bool>()) continue;
    const auto joints = solution["joints"].get<std::vector<double>>();
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(joints.data(), seed.size());
    EXPECT_LE(solution["residual_m"].get<double>(), residual) << solution;
    EXPECT_LE(solution["residual_rad"].get<double>(), residual) << solution;
    if ((q - seed).norm() < (best - seed).norm()) best = q;
  }
  return best;
}

TEST(IkSolvers, AgreeOnEveryGoalOfTheDefaultRun) {
  DeploymentRun run;
  const std::vector<Question> questions =
      questions_of(record_lamp({.settings = {kSimulated}}, run));
  ASSERT_EQ(run.command.exit_code, 0) << run.text();
  ASSERT_GT(questions.size(), 10U);
  const auto geometric = ask("ik/lamp_geometric", questions);
  const auto numeric = ask("ik/numeric", questions);
  ASSERT_EQ(geometric.size(), questions.size());
  ASSERT_EQ(numeric.size(), questions.size());
  for (std::size_t i = 0; i < questions.size(); ++i) {
    SCOPED_TRACE("question " + std::to_string(i));
    const auto closed_form = nearest(geometric[i], questions[i].seed, kClosedForm);
    const auto iterated = nearest(numeric[i], questions[i].seed, kAgree);
    EXPECT_LE((closed_form - iterated).cwiseAbs().maxCoeff(), kAgree)
        << closed_form.transpose() << "\n"
        << iterated.transpose();
    EXPECT_LE((closed_form - questions[i].chosen).cwiseAbs().maxCoeff(), kAgree);
  }
}

}  // namespace
}  // namespace armature::test
