// SPDX-License-Identifier: Apache-2.0
// Every published deployment for the sanitizers, which see what runs: once to the end of its
// scenario, and once in several processes and with all of its threads. tools/test --full runs it in
// their builds.
#include <gmock/gmock.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Sanitized : public testing::TestWithParam<const char*> {
 protected:
  static DeploymentRun run(std::vector<std::string> settings) {
    const std::string file = std::string{"configs/"} + GetParam() + ".yaml";
    return run_deployment({.files = {source_file(file)}, .settings = std::move(settings)});
  }
  static void expect_no_report(const DeploymentRun& run) {
    EXPECT_THAT(run.command.err, Not(HasSubstr("Sanitizer"))) << run.text();
    EXPECT_THAT(run.command.err, Not(HasSubstr("runtime error:"))) << run.text();
    EXPECT_FALSE(run.command.timed_out);
  }
};

TEST_P(Sanitized, DeploymentTellsItsStoryInLockstep) {
  const DeploymentRun told = run({kSimulated});
  expect_no_report(told);
  EXPECT_EQ(told.command.exit_code, 0) << told.text();
}

TEST_P(Sanitized, DeploymentMovesOnTheSystemClockInSeveralProcesses) {
  // What a sanitizer makes slow does not keep times: how the run ends is another test's.
  const DeploymentRun ended =
      run({"clock=system", "run.time_limit_s=10", "components.arm.process=aside",
           "components.monitor.process=watching"});
  expect_no_report(ended);
  EXPECT_THAT(ended.command.err, HasSubstr("stopping: ")) << ended.text();
}

INSTANTIATE_TEST_SUITE_P(All, Sanitized,
                         testing::Values("dental_lamp", "sr1_biopsy", "sr1_touching",
                                         "dental_implant", "master_manipulator"),
                         [](const auto& deployment) { return std::string{deployment.param}; });

}  // namespace
}  // namespace armature::test
