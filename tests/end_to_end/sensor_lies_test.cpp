// SPDX-License-Identifier: Apache-2.0
// What an arm does of itself while its measured_js is not so, by where it truly is: 1. one that is
// stopped, or rests, does not move, 2. one that moves stays within its limits and comes to rest, 3.
// a needle goes no deeper than it was planned to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "joint_table.hpp"

namespace armature::test {
namespace {

struct Lie {
  std::string word;
  double amount = 0;  // [rad] or [m]; of a drift in a second
};

std::ostream& operator<<(std::ostream& out, const Lie& lie) {
  return out << lie.word << ' ' << lie.amount;
}

struct LyingRun {
  DeploymentRun run;
  JointTable truth;

  /// How far a joint has been from where it was at `from_s`, the most. [rad] or [m]
  double moved_since(double from_s) const {
    const std::size_t time = truth.column("time_s");
    const auto begin = std::ranges::find_if(
        truth.rows, [&](const auto& row) { return row[time] >= from_s - 1e-9; });
    if (begin == truth.rows.end()) return NAN;
    double most = 0;
    for (const std::size_t joint : truth.positions()) {
      for (auto row = begin; row != truth.rows.end(); ++row) {
        most = std::max(most, std::abs((*row)[joint] - (*begin)[joint]));
      }
    }
    return most;
  }
  double end_s() const { return truth.rows.back()[truth.column("time_s")]; }
};

/// `settings` beside those of the lie, which begins at `from_s`, of the joint of that number.
LyingRun run_with(const Lie& lie, double from_s, const std::string& file,
                  std::vector<std::string> settings, int joint = 0) {
  const TemporaryFolder folder;
  const std::string sensor = "components.sensor.params.";
  settings.insert(
      settings.end(),
      {kSimulated, "components.truth.params.file=" + (folder / "truth").string(),
       sensor + "lie=" + lie.word, sensor + "amount=" + std::to_string(lie.amount),
       sensor + "joint=" + std::to_string(joint), sensor + "from_s=" + std::to_string(from_s)});
  DeploymentStart start{
      .files = {source_file(file), source_file("tests/end_to_end/lying_sensor.yaml")},
      .settings = std::move(settings)};
  start.options.environment["ARMATURE_PLUGIN_PATH"] = TEST_PLUGINS;
  LyingRun lying{.run = run_deployment(start), .truth = {}};
  if (!std::filesystem::exists(folder / "truth.csv")) throw std::runtime_error{lying.run.text()};
  lying.truth = read_joint_table(content_of(folder / "truth.csv"));
  return lying;
}

class ALyingSensor : public testing::TestWithParam<Lie> {};

// 1.

TEST_P(ALyingSensor, MovesNoStoppedArm) {
  const LyingRun lying = run_with(GetParam(), 4, "tests/faults/tour.yaml",
                                  {"components.sensor.params.stop_at_s=1.5",
                                   "components.task.params.rest_s=100", "run.time_limit_s=8"});
  SCOPED_TRACE(lying.run.text());
  EXPECT_GT(lying.moved_since(0), 0.1) << "it moved before the stop";
  ASSERT_GT(lying.end_s(), 7);
  EXPECT_EQ(lying.moved_since(3.9), 0);
}

TEST_P(ALyingSensor, MovesNoRestingArm) {
  const LyingRun lying = run_with(GetParam(), 6, "tests/faults/tour.yaml",
                                  {"components.task.params.rest_s=100", "run.time_limit_s=10"});
  SCOPED_TRACE(lying.run.text());
  EXPECT_GT(lying.moved_since(0), 0.1) << "it moved before it rested";
  ASSERT_GT(lying.end_s(), 9);
  EXPECT_EQ(lying.moved_since(5.9), 0);
}

// 2.

TEST_P(ALyingSensor, LeavesAMovingArmWithinItsLimitsAndBringsItToRest) {
  const LyingRun lying = run_with(GetParam(), 1, "tests/faults/tour.yaml", {"run.time_limit_s=6"});
  SCOPED_TRACE(lying.run.text());
  constexpr double kMaxVelocity = 0.5, kMaxAcceleration = 1;  // of the tour
  const std::size_t time = lying.truth.column("time_s");
  for (std::size_t i = 1; i < lying.truth.rows.size(); ++i) {
    const auto &row = lying.truth.rows[i], &before = lying.truth.rows[i - 1];
    for (const std::size_t joint : lying.truth.positions()) {
      const double speed = (row[joint] - before[joint]) / (row[time] - before[time]);
      ASSERT_LT(std::abs(speed), kMaxVelocity + 0.01 * kMaxAcceleration) << row[time] << " s";
    }
  }
  EXPECT_LT(lying.moved_since(lying.end_s() - 0.04), 2e-4) << "rest_tolerance_rad, to both sides";
}

INSTANTIATE_TEST_SUITE_P(Of, ALyingSensor,
                         testing::Values(Lie{"stuck"}, Lie{"offset", 0.003}, Lie{"offset", -0.05},
                                         Lie{"offset", 0.3}, Lie{"drift", 0.002},
                                         Lie{"drift", -0.05}, Lie{"jump", 0.3},
                                         Lie{"to_and_fro", 0.3}, Lie{"late"}, Lie{"negated"}),
                         [](const auto& lie) {
                           std::string name =
                               lie.param.word + "_" + std::to_string(lie.param.amount);
                           std::ranges::replace(name, '.', '_');
                           std::ranges::replace(name, '-', 'm');
                           return name;
                         });

// 3.

double deepest(const LyingRun& run) {
  const std::size_t needle = run.truth.column("needle_m");
  double most = 0;
  for (const auto& row : run.truth.rows) most = std::max(most, row[needle]);
  return most;
}

TEST(ALyingSensorOfANeedle, DrivesItNoDeeperThanItsPlan) {
  constexpr int kNeedle = 5;
  const std::string biopsy = "configs/sr1_biopsy.yaml";
  const double planned_m = deepest(run_with({"none"}, 0, biopsy, {}, kNeedle));
  EXPECT_GT(planned_m, 0.2);
  for (const Lie& lie :
       {Lie{"offset", 0.00015}, Lie{"offset", -0.00015}, Lie{"offset", 0.06}, Lie{"offset", -0.06},
        Lie{"drift", 0.01}, Lie{"drift", -0.01}, Lie{"jump", 0.06}, Lie{"stuck"}}) {
    for (const double from_s : {7.4, 9.0}) {  // on its way in, and at its target
      SCOPED_TRACE(testing::Message{} << lie << " from " << from_s << " s on");
      const LyingRun lying = run_with(lie, from_s, biopsy, {}, kNeedle);
      EXPECT_LT(deepest(lying), planned_m + 1e-5) << lying.run.text();
    }
  }
}

}  // namespace
}  // namespace armature::test
