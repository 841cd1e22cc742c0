// SPDX-License-Identifier: Apache-2.0
// A link between motion and the driver of an arm that does anything to what passes, threads that
// are held up, and what the arm does, by where it truly is: 1. it keeps its limits, 2. it stops
// when commands cease, 3. it sets out again for a command that is near only, 4. it rests where the
// newest command rests, 5. the run comes to its end once the link is calm. ARMATURE_LINKS: so many
// of every system, from number ARMATURE_FIRST_LINK on; `tools/test --full` has others every day.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "arm_limits.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "held_up_threads.hpp"
#include "tests/dds_domain.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

struct LinkedSystem {
  std::string name, file, robot;
  std::vector<std::string> settings;
};

std::ostream& operator<<(std::ostream& out, const LinkedSystem& system) {
  return out << system.name;
}

/// What the link wrote of a step of the arm, and of the newest command that had come to it.
struct LinkedStep {
  double time_s = 0, stamp_s = -1;
  JointVector q, told_q, told_v;
};

struct LinkedRun {
  DeploymentRun run;
  std::vector<LinkedStep> steps;
  std::string story;  // what the link did, and the task
};

LinkedRun read_linked_run(const std::string& text, const RobotModel& robot) {
  LinkedRun run;
  LinkedStep newest;
  std::istringstream lines{text};
  for (std::string one; std::getline(lines, one);) {
    std::istringstream line{one};
    std::string kind;
    double time_s = 0;
    line >> kind >> time_s;
    if (kind == "told") line >> newest.stamp_s;
    if (kind == "link" || kind == "task") run.story += one + "\n";
    std::vector<double> values;
    for (double value = 0; line >> value;) values.push_back(value);
    const auto joints = static_cast<std::size_t>(robot.joint_count());
    if (kind == "told") {
      newest.told_q = robot.to_independent(std::span{values}.first(joints)).value();
      newest.told_v = robot.contract_rates(std::span{values}.last(joints)).value();
    }
    if (kind != "arm") continue;
    newest.time_s = time_s;
    newest.q = robot.to_independent(std::span<const double>{values}).value();
    run.steps.push_back(newest);
  }
  return run;
}

class AnyLink : public testing::TestWithParam<LinkedSystem> {
 protected:
  static constexpr double kTimeout_s = 0.1;  // command_timeout_s

  LinkedRun run_with(int seed, const std::vector<std::string>& settings) const {
    static const int kDomain = unique_dds_domain();  // one run at a time
    const TemporaryFolder folder;
    const std::string file = folder / "chronicle", params = "components.link.params.";
    DeploymentStart start{
        .files = {source_file(GetParam().file), source_file("tests/by_lot/any_link.yaml")},
        .settings = GetParam().settings,
        .domain = kDomain};
    start.settings.insert(start.settings.end(),
                          {params + "file=" + file, params + "seed=" + std::to_string(seed),
                           params + "one_way=" + (seed % 3 == 0 ? "true" : "false")});
    start.settings.insert(start.settings.end(), settings.begin(), settings.end());
    start.options.environment["ARMATURE_PLUGIN_PATH"] = TEST_PLUGINS;
    const DeploymentRun run = run_deployment(start);
    if (!std::filesystem::exists(file)) throw std::runtime_error{run.text()};
    LinkedRun linked = read_linked_run(content_of(file), robot_);
    linked.run = run;
    return linked;
  }

  static std::string again(int seed, const LinkedRun& run) {
    return fmt::format("again: ARMATURE_FIRST_LINK={} ARMATURE_LINKS=1\n{}{}", seed, run.story,
                       run.run.text());
  }
  void expect_arm(const LinkedRun& run, double longest_pause_s) const {
    expect_arm_limits(robot_, run.steps);
    expect_stops(run, longest_pause_s);
    expect_rest(run);
  }
  void expect_stops(const LinkedRun& run, double longest_pause_s) const;
  void expect_rest(const LinkedRun& run) const;
  bool waits_for(const LinkedStep& step) const;

  const RobotModel robot_ = load_robot_model(source_file("configs/robots/" + GetParam().robot));
};

double farthest(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// A command that is so far away after a stop of the arm's own is waited for to come near.
bool AnyLink::waits_for(const LinkedStep& step) const {
  constexpr double kFar_rad = 0.1, kFar_m = 0.05;
  for (int i = 0; i < robot_.dof(); ++i) {
    const double far = robot_.is_revolute(i) ? kFar_rad : kFar_m;
    if (std::abs(step.told_q[i] - step.q[i]) > far) return true;
  }
  return false;
}

// 2. and 3.

void AnyLink::expect_stops(const LinkedRun& run, double longest_pause_s) const {
  const double braking_s =
      robot_.max_velocity().cwiseQuotient(robot_.max_acceleration()).maxCoeff() + 0.003 +
      2 * longest_pause_s;
  constexpr double kNear_rad = 0.1, kNear_m = 0.05;
  const LinkedStep* stands = nullptr;
  for (const LinkedStep& step : run.steps) {
    const bool silent = step.time_s - step.stamp_s > kTimeout_s + braking_s;
    if (silent && !stands) stands = &step;
    if (!stands || step.q == stands->q) continue;
    ASSERT_FALSE(silent) << step.time_s << " s: it moves without a command";
    for (int i = 0; i < robot_.dof(); ++i) {
      ASSERT_LE(std::abs(step.told_q[i] - stands->q[i]),
                (robot_.is_revolute(i) ? kNear_rad : kNear_m) + 0.001)
          << step.time_s << " s: it sets out for a command that is far";
    }
    stands = nullptr;
  }
}

// 4.

void AnyLink::expect_rest(const LinkedRun& run) const {
  constexpr double kSettled_s = 1;
  const LinkedStep* rests = nullptr;
  for (const LinkedStep& step : run.steps) {
    if (step.told_v.size() == 0) continue;
    const bool same = rests && rests->told_q == step.told_q;
    if (!same) rests = step.told_v.isZero(0) ? &step : nullptr;
    if (!rests || step.time_s < rests->time_s + kSettled_s) continue;
    const LinkedStep* settled = rests;
    while (settled->time_s < rests->time_s + kSettled_s) ++settled;
    ASSERT_LE(farthest(step.q, settled->q), 1e-9)
        << step.time_s << " s: the newest command rests since " << rests->time_s << " s";
    ASSERT_TRUE(farthest(step.q, step.told_q) <= 1e-9 || waits_for(step))
        << step.time_s << " s: at " << step.q.transpose() << ", told " << step.told_q.transpose();
  }
}

TEST_P(AnyLink, LetsNoArmMoveOtherwiseThanItMay) {
  const int first = environment_number("ARMATURE_FIRST_LINK", 1),
            count = environment_number("ARMATURE_LINKS", 3);
  for (int seed = first; seed < first + count; ++seed) {
    const double pause_s = seed % 2 == 0 ? 0.02 * (seed % 7) : 0;
    const LinkedRun run = run_with(seed, held_up_threads(seed, pause_s, pause_s));
    SCOPED_TRACE(again(seed, run));
    expect_arm(run, pause_s);
    const std::string status = run.run.status();
    EXPECT_TRUE(status == "ok" || status == "refused") << run.run.report;
    EXPECT_EQ(run.run.report.find("time limit"), std::string::npos);
  }
}

/// Pauses that are shorter than what a command lasts and motion may be late hinder nothing.
TEST_P(AnyLink, MayHaveThreadsThatAreHeldUp) {
  const int first = environment_number("ARMATURE_FIRST_LINK", 1),
            count = environment_number("ARMATURE_LINKS", 3);
  for (int seed = first; seed < first + count; ++seed) {
    const double control_s = 0.0002 * std::pow(200, (4 * seed % 11) / 10.0),
                 main_s = 0.0002 * std::pow(1000, (5 * seed % 13) / 12.0);
    auto settings = held_up_threads(seed, control_s, main_s);
    settings.push_back("components.link.params.calm_after_s=0");
    const LinkedRun run = run_with(seed, settings);
    SCOPED_TRACE(again(seed, run));
    expect_arm(run, control_s);
    EXPECT_EQ(run.run.status(), "ok") << run.run.report;
    EXPECT_EQ(run.run.text().find("asks joint"), std::string::npos) << "of a good stream";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyLink,
    testing::Values(LinkedSystem{.name = "Tour",
                                 .file = "tests/faults/tour.yaml",
                                 .robot = "med7.yaml",
                                 .settings = {"components.task.params.rounds=4",
                                              "components.task.params.rest_s=0.5"}},
                    LinkedSystem{.name = "Biopsy",
                                 .file = "configs/sr1_biopsy.yaml",
                                 .robot = "sr1_needle.yaml",
                                 .settings = {}}),
    [](const auto& system) { return system.param.name; });

}  // namespace
}  // namespace armature::test
