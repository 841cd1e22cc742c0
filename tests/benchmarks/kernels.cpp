// SPDX-License-Identifier: Apache-2.0
// What the solvers are made of, by itself: forward kinematics, Jacobian and one solve, for every
// robot of configs/robots and every solver that serves it; and a sample of each orientation curve.
// `armature bench ik` compares solvers; this shows where their time goes.
// --benchmark_filter=fk/dental_lamp
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/batch.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/task_error.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using RobotPtr = std::shared_ptr<const RobotModel>;

constexpr std::size_t kPostures = 256;  // a power of two

std::vector<JointVector> postures(const RobotModel& robot) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> part{0, 1};
  std::vector<JointVector> list(kPostures, JointVector(robot.dof()));
  for (JointVector& q : list) {
    for (int i = 0; i < robot.dof(); ++i) {
      q[i] = std::lerp(robot.lower()[i], robot.upper()[i], part(random));
    }
  }
  return list;
}

IkGoal goal_at(const RobotModel& robot, const JointVector& q) {
  return {.pose = task_pose(robot, q), .tolerance = {.position_m = 1e-6, .angle_rad = 1e-6}};
}

void fk(benchmark::State& state, const RobotPtr& robot) {
  const auto list = postures(*robot);
  for (std::size_t i = 0; auto _ : state) {
    benchmark::DoNotOptimize(forward_kinematics(*robot, list[++i % kPostures]));
  }
}

void jacobian(benchmark::State& state, const RobotPtr& robot) {
  const auto list = postures(*robot);
  for (std::size_t i = 0; auto _ : state) {
    benchmark::DoNotOptimize(
        forward_kinematics_with_jacobian(*robot, list[++i % kPostures], robot->tool()));
  }
}

/// From the posture of another goal: a seed anywhere. The redundancy is the solver's choice, or
/// that of the posture that made the goal.
enum class Redundancy { chosen, given };
void solve(benchmark::State& state, const IkSubject& subject, Redundancy redundancy) {
  const auto list = postures(*subject.model);
  std::vector<IkGoal> goals;
  for (const JointVector& q : list) {
    goals.push_back(goal_at(*subject.model, q));
    if (redundancy == Redundancy::chosen) continue;
    goals.back().redundancy = subject.solver->redundancy_of(q);
  }
  IkBranches found;
  for (std::size_t i = 0; auto _ : state) {
    ++i;
    IkState memory;
    benchmark::DoNotOptimize(
        subject.solver->solve(goals[i % kPostures], list[(i + 1) % kPostures], found, memory));
  }
}

/// A goal of a batch of them.
void solve_batch(benchmark::State& state, const IkSubject& subject) {
  constexpr std::size_t kNumbers = 7;  // x, y, z and w, x, y, z, or a direction
  std::array<std::vector<double>, kNumbers> numbers;
  const auto list = postures(*subject.model);
  for (const JointVector& q : list) {
    const IkGoal goal = goal_at(*subject.model, q);
    Eigen::Matrix<double, kNumbers, 1> one;
    if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
      one << goal.pose.position, direction->unit, 0;
    } else {
      const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
      one << goal.pose.position, rotation.w(), rotation.vec();
    }
    for (std::size_t k = 0; k < kNumbers; ++k) {
      numbers[k].push_back(one[static_cast<Eigen::Index>(k)]);
    }
  }
  IkBatch batch;
  batch.count = kPostures;
  batch.tolerance = {.position_m = 1e-6, .angle_rad = 1e-6};
  const auto point = [&](auto& to, std::size_t from) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = numbers[from + k].data();
  };
  point(batch.position, 0);
  if (subject.model->pointing_axis()) {
    point(batch.direction, 3);
  } else {
    point(batch.rotation, 3);
  }
  IkBatchAnswers answers;
  while (state.KeepRunningBatch(kPostures)) {
    subject.solver->solve_batch(batch, list.front(), answers);
    benchmark::DoNotOptimize(answers.found.data());
  }
}

/// Rotation, angular velocity and angular acceleration anywhere on a curve through eight keys.
void orientation(benchmark::State& state, OrientationInterpolator interpolator) {
  std::mt19937_64 random{1};
  std::normal_distribution<double> normal;
  std::vector<Eigen::Quaterniond> keys(8);
  for (auto& key : keys) {
    key.coeffs() = Eigen::Vector4d::NullaryExpr([&] { return normal(random); }).normalized();
  }
  const OrientationCurve curve = OrientationCurve::through(keys, interpolator).value();
  std::uniform_real_distribution<double> part{0, 1};
  std::vector<double> u(kPostures);
  for (double& each : u) each = part(random);
  for (std::size_t i = 0; auto _ : state) {
    benchmark::DoNotOptimize(curve.at(u[++i % kPostures]));
  }
}

void add_orientations() {
  for (const std::string name : {"slerp", "squad", "rotvec_bspline", "chart_bspline"}) {
    const OrientationInterpolator interpolator = *orientation_interpolator(name);
    benchmark::RegisterBenchmark(
        ("orientation/" + name).c_str(),
        [interpolator](benchmark::State& state) { orientation(state, interpolator); });
  }
}

/// Goals that the solver says are out of reach: those of the postures, moved away from the base or
/// towards it until it says so, to a thousandth of that distance.
enum class Beyond { too_far, too_near };
std::vector<IkGoal> out_of_reach(const IkSubject& subject, Beyond beyond) {
  std::vector<IkGoal> goals;
  const JointVector seed = resting_position(*subject.model);
  for (const JointVector& q : postures(*subject.model)) {
    const IkGoal reached = goal_at(*subject.model, q);
    const auto moved = [&](double factor) {
      IkGoal goal = reached;
      goal.pose.position *= factor;
      return goal;
    };
    const auto refused = [&](double factor) {
      IkBranches found;
      IkState state;
      return subject.solver->solve(moved(factor), seed, found, state).code ==
             IkStatus::Code::out_of_reach;
    };
    double inside = 1, outside = beyond == Beyond::too_far ? 20 : 0;
    if (!refused(outside)) continue;
    while (std::abs(outside - inside) > 1e-3) {
      const double middle = std::midpoint(inside, outside);
      (refused(middle) ? outside : inside) = middle;
    }
    goals.push_back(moved(outside));
  }
  return goals;
}

void refuse(benchmark::State& state, const IkSubject& subject, const std::vector<IkGoal>& goals) {
  const auto seeds = postures(*subject.model);
  IkBranches found;
  for (std::size_t i = 0; auto _ : state) {
    ++i;
    IkState memory;
    benchmark::DoNotOptimize(
        subject.solver->solve(goals[i % goals.size()], seeds[i % kPostures], found, memory));
  }
}

void add_robot(PluginRegistry& plugins, const RobotPtr& robot) {
  const auto add = [](const std::string& name, auto body) {
    benchmark::RegisterBenchmark(name.c_str(), body);
  };
  add("fk/" + robot->name(), [robot](benchmark::State& state) { fk(state, robot); });
  add("jacobian/" + robot->name(), [robot](benchmark::State& state) { jacobian(state, robot); });
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (plugin.kind != IkSolver::kKind) continue;
    config::Problems problems;
    const Params params = Params::read(plugin.params, nullptr, plugin.id, problems);
    if (!problems.empty()) continue;  // needs parameters
    auto subject = plugin_subject(plugins, plugin, robot, params);
    if (!subject) continue;  // does not serve it
    add("solve/" + plugin.id + "/" + robot->name(),
        [made = *subject](benchmark::State& state) { solve(state, made, Redundancy::chosen); });
    add("solve_batch/" + plugin.id + "/" + robot->name(),
        [made = *subject](benchmark::State& state) { solve_batch(state, made); });
    for (const auto& [kind, beyond] :
         {std::pair{"too_far", Beyond::too_far}, {"too_near", Beyond::too_near}}) {
      const auto goals = out_of_reach(*subject, beyond);
      if (goals.empty()) continue;
      add(std::string{"solve_"} + kind + "/" + plugin.id + "/" + robot->name(),
          [made = *subject, goals](benchmark::State& state) { refuse(state, made, goals); });
    }
    if (!subject->solver->redundancy_of(resting_position(*robot))) continue;
    add("solve_at_redundancy/" + plugin.id + "/" + robot->name(),
        [made = *subject](benchmark::State& state) { solve(state, made, Redundancy::given); });
  }
}

}  // namespace
}  // namespace armature

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  armature::PluginRegistry plugins;
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& file : files) {
    armature::add_robot(
        plugins, std::make_shared<const armature::RobotModel>(armature::load_robot_model(file)));
  }
  armature::add_orientations();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
