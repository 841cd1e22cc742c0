// SPDX-License-Identifier: Apache-2.0
// What `--report` tells of the joints of all four systems: 1. tables, errors and pictures, the same
// in every run, 2. a run that is killed, with its arm in another process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <thread>

#include "armature/values/angles.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "joint_table.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

/// Of the tool against its goal when the last one was met, as the deployment's own goals have it.
struct Tolerance {
  double position_m, orientation_rad;
};

struct System {
  std::string name;                       // of the file in configs/
  std::map<std::string, Tolerance> arms;  // by the driver's name
  double joint_error;                     // [rad] and [m] at the end: goal_tolerance of the motion
};

std::ostream& operator<<(std::ostream& out, const System& system) { return out << system.name; }

void expect_even_times(const JointTable& table) {
  const std::size_t time = table.column("time_s");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    ASSERT_NEAR(table.rows[i][time], 0.01 * static_cast<double>(i), 1e-9);
  }
}

/// Every error is measured minus reference, to the nine digits that are told.
void expect_errors_that_add_up(const JointTable& table) {
  for (std::size_t e = 0; e < table.names.size(); ++e) {
    const std::size_t at = table.names[e].find("_error_");
    if (at == std::string::npos || table.names[e].starts_with("goal_")) continue;
    const std::string joint = table.names[e].substr(0, at), unit = table.names[e].substr(at + 7);
    const std::size_t q = table.column(joint + '_' + unit);
    const std::size_t r = table.column(joint + "_reference_" + unit);
    for (const auto& row : table.rows) {
      if (std::isnan(row[e])) continue;
      ASSERT_NEAR(row[e], row[q] - row[r], 1e-8) << table.names[e];
    }
  }
}

/// At the end the arm stands, and every joint is where it shall be.
void expect_rest(const JointTable& table, double tolerance) {
  const auto& last = table.rows.back();
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& name = table.names[i];
    if (name.starts_with("goal_") || name == "stamp_s" || name == "time_s") continue;
    const bool is_error = name.find("_error_") != std::string::npos;
    if (name.ends_with("_s")) {
      EXPECT_LT(std::abs(last[i]), 1e-3) << name;
    } else if (is_error) {
      EXPECT_LT(std::abs(last[i]), tolerance) << name;
    }
  }
}

void expect_goal_met(const JointTable& table, const Tolerance& tolerance) {
  const std::size_t position = table.column("goal_position_error_m");
  const std::size_t orientation = table.column("goal_orientation_error_rad");
  const auto has_goal = [&](const auto& row) { return !std::isnan(row[position]); };
  const auto first = std::ranges::find_if(table.rows, has_goal);
  const auto last = std::find_if(table.rows.rbegin(), table.rows.rend(), has_goal);
  ASSERT_NE(first, table.rows.end());
  EXPECT_LT((*last)[position], tolerance.position_m);
  EXPECT_LT((*last)[orientation], tolerance.orientation_rad);
}

class JointReport : public testing::TestWithParam<System> {
 protected:
  const TemporaryFolder folder_;
};

// 1.

TEST_P(JointReport, TellsEveryArmTheSameInEveryRunAndChangesNothing) {
  const System& system = GetParam();
  DeploymentStart start{.files = {source_file("configs/" + system.name + ".yaml")},
                        .settings = {kSimulated}};
  const DeploymentRun plain = run_deployment(start);
  start.report_folder = folder_ / "first";
  const DeploymentRun first = run_deployment(start);
  start.report_folder = folder_ / "second";
  const DeploymentRun second = run_deployment(start);
  ASSERT_EQ(first.command.exit_code, 0) << first.text();
  EXPECT_EQ(plain.report, first.report) << "the report changes nothing";
  for (const auto& [arm, tolerance] : system.arms) {
    SCOPED_TRACE(arm);
    const std::string csv = arm + "_joints.csv", svg = arm + "_joints.svg";
    const std::string text = content_of(folder_ / "first" / csv);
    EXPECT_TRUE(text == content_of(folder_ / "second" / csv)) << "byte for byte";
    EXPECT_TRUE(content_of(folder_ / "first" / svg) == content_of(folder_ / "second" / svg));
    const JointTable table = read_joint_table(text);
    ASSERT_GT(table.rows.size(), 100u);
    expect_even_times(table);
    expect_errors_that_add_up(table);
    expect_rest(table, system.joint_error);
    expect_goal_met(table, tolerance);
    EXPECT_NE(content_of(folder_ / "first" / svg).find("joint speed [rad/s]"), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, JointReport,
    testing::Values(System{"dental_lamp", {{"arm", {1.5e-3, 2.5 * kRadPerDegree}}}, 2e-3},
                    System{"sr1_biopsy", {{"arm", {1e-5, 0.01 * kRadPerDegree}}}, 1e-4},
                    System{"dental_implant", {{"arm", {5e-5, 0.01 * kRadPerDegree}}}, 2e-4},
                    // The follower trails: its tracking_error_mm, and goal_tolerance_rad.
                    System{"master_manipulator",
                           {{"leader", {1e-5, 0.001 * kRadPerDegree}}, {"arm", {1e-4, 2e-3}}},
                           5e-4}),
    [](const auto& system) { return system.param.name; });

// 2.

class KilledRun : public JointReport {};

TEST_P(KilledRun, LeavesWholeLinesOfAnArmInAnotherProcess) {
  const fs::path csv = folder_ / "arm_joints.csv";
  {
    Command run{deployment_command(
        {.settings = {"components.arm.process=arm", "components.arm.executor=arm",
                      "executors.arm.period_s=0.001"},
         .report_folder = folder_.path()})};
    constexpr std::size_t kEnough = 40'000;  // bytes: a second and a half
    for (int i = 0; i < 600 && content_of(csv).size() < kEnough; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    run.signal(SIGKILL);
    run.finish(std::chrono::seconds{10});
  }
  const JointTable table = read_joint_table(content_of(csv));
  ASSERT_GT(table.rows.size(), 50u);
  const std::size_t time = table.column("time_s"), error = table.column("j1_error_rad");
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    EXPECT_GT(table.rows[i][time], table.rows[i - 1][time]);
  }
  EXPECT_FALSE(std::isnan(table.rows.back()[error])) << "the reference is there, too";
}

INSTANTIATE_TEST_SUITE_P(Of, KilledRun, testing::Values(System{"dental_lamp", {}, 0}));

}  // namespace
}  // namespace armature::test
