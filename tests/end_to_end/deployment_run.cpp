// SPDX-License-Identifier: Apache-2.0
#include "deployment_run.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

// Far beyond what a run takes: only a hang ends here.
constexpr std::chrono::seconds kTimeout{180};

/// Null when there is none of that name.
nlohmann::json value_of(const DeploymentRun& run, const std::string& name) {
  const auto report = nlohmann::json::parse(run.report, nullptr, false);
  return report.is_object() ? report.value(name, nlohmann::json{}) : nlohmann::json{};
}

}  // namespace

double DeploymentRun::figure(const std::string& name) const {
  const auto value = value_of(*this, name);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string DeploymentRun::word(const std::string& name) const {
  const auto value = value_of(*this, name);
  return value.is_string() ? value.get<std::string>() : "none";
}

bool DeploymentRun::tells(const std::string& name) const {
  return !value_of(*this, name).is_null();
}

std::string DeploymentRun::text() const {
  return "exit code " + std::to_string(command.exit_code) +
         (command.timed_out ? " (timed out)" : "") + "\n" + command.out + command.err;
}

std::vector<std::string> deployment_command(const DeploymentStart& start) {
  std::vector<std::string> command{armature(), "run"};
  command.insert(command.end(), start.files.begin(), start.files.end());
  const int domain = start.domain > 0 ? start.domain : unique_dds_domain();
  command.insert(command.end(), {"--json", "--domain", std::to_string(domain)});
  for (const auto& setting : start.settings) command.insert(command.end(), {"--set", setting});
  if (!start.report_folder.empty()) {
    command.insert(command.end(), {"--report", start.report_folder});
  }
  return command;
}

DeploymentRun run_deployment(const DeploymentStart& start) {
  DeploymentRun run{.command = run_command(deployment_command(start), start.options, kTimeout),
                    .report = {}};
  if (nlohmann::json::parse(run.command.out, nullptr, false).is_object()) {
    run.report = run.command.out;
  }
  return run;
}

void expect_aligned(const DeploymentRun& run, const LampGoals& goals) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 0);
  EXPECT_EQ(run.status(), "ok");
  EXPECT_LE(run.figure("mouth_position_error_mm"), goals.mouth_mm);
  EXPECT_LE(run.figure("face_normal_error_deg"), goals.normal_deg);
  EXPECT_LE(run.figure("distance_error_mm"), goals.distance_mm);
  EXPECT_LE(run.figure("direction_error_deg"), goals.direction_deg);
  EXPECT_LE(run.figure("time_to_find_s"), run.figure("time_to_align_s"));
}

}  // namespace armature::test
