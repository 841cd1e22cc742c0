// SPDX-License-Identifier: Apache-2.0
// `armature stop`: it says who has taken the stop, and fails when nobody can have.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using testing::HasSubstr;

constexpr std::chrono::seconds kAtMost{30};
constexpr int kNobodyHeard = 5;

class StopCommand : public testing::Test {
 protected:
  CommandResult stop(const std::string& timeout_s) const {
    return run_command({armature(), "stop", "--domain", domain_, "--timeout", timeout_s}, {},
                       kAtMost);
  }
  /// A deployment under that name whose arm stands still: its needle waits for an operator.
  std::vector<std::string> waiting(const std::string& name) const {
    return {armature(),
            "run",
            source_file("configs/sr1_biopsy.yaml"),
            source_file("configs/overlays/operated.yaml"),
            "--domain",
            domain_,
            "--set",
            "name=" + name};
  }
  std::string halted(const std::string& name, pid_t pid) const {
    return "deployment '" + name + "' (pid " + std::to_string(pid) +
           ") runs on this machine in domain " + domain_ +
           " and does not answer: it is halted. 'kill -CONT " + std::to_string(pid) +
           "' lets it go on; until then use the arm's own emergency stop";
  }
  const std::string domain_ = std::to_string(unique_dds_domain());
};

TEST_F(StopCommand, NamesTheDeploymentThatHasStopped) {
  Command run{{armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--set", "clock=system",
               "--domain", domain_},
              {}};
  ASSERT_TRUE(run.wait_for_err("task      approach", kAtMost)) << run.err();
  const CommandResult result = stop("1e10");  // longer than a clock, and DDS, can count
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("stopped: deployment 'sr1_biopsy', process 'main' (pid " +
                                    std::to_string(run.pid())));
  EXPECT_TRUE(run.wait_for_err("motion    stopped until it is rearmed", kAtMost)) << run.err();
}

TEST_F(StopCommand, FailsWhereThereIsNoDeployment) {
  const CommandResult result = stop("0.5");
  EXPECT_EQ(result.exit_code, kNobodyHeard);
  EXPECT_THAT(result.err,
              HasSubstr("no deployment in domain " + domain_ + " heard the stop within 0.5 s"));
}

TEST_F(StopCommand, NamesADeploymentThatIsHaltedAndNotAnotherDomain) {
  Command run{waiting("needle")};
  ASSERT_TRUE(run.wait_for_err("asks the operator", kAtMost)) << run.err();
  run.signal(SIGSTOP);
  const CommandResult result = stop("1.5");
  run.signal(SIGCONT);
  EXPECT_EQ(result.exit_code, kNobodyHeard);
  EXPECT_THAT(result.err, HasSubstr(halted("needle", run.pid())));
  EXPECT_THAT(result.err, testing::Not(HasSubstr("says its domain")));
  // Once it goes on it hears of that command, which has gone.
  EXPECT_EQ(stop("20").exit_code, 0);
  EXPECT_THAT(run.err(), testing::Not(HasSubstr("another container")));
}

TEST_F(StopCommand, FailsWhenOneOfTwoDeploymentsIsHalted) {
  Command first{waiting("first")}, second{waiting("second")};
  ASSERT_TRUE(first.wait_for_err("asks the operator", kAtMost)) << first.err();
  ASSERT_TRUE(second.wait_for_err("asks the operator", kAtMost)) << second.err();
  second.signal(SIGSTOP);
  const CommandResult result = stop("20");
  second.signal(SIGCONT);
  EXPECT_EQ(result.exit_code, kNobodyHeard);
  EXPECT_THAT(result.out, HasSubstr("deployment 'first'")) << result.err << first.err();
  EXPECT_THAT(result.err, HasSubstr(halted("second", second.pid())));
}

TEST_F(StopCommand, FailsWhereOnlyARecorderHearsIt) {
  Command recorder{{armature(), "topic", "echo", "/stop", "--domain", domain_}, {}};
  const CommandResult result = stop("1.5");
  EXPECT_EQ(result.exit_code, kNobodyHeard);
  EXPECT_THAT(result.err, HasSubstr("(pid " + std::to_string(recorder.pid()) + " on "));
  EXPECT_THAT(result.err, HasSubstr("reads /stop, and is no deployment"));
}

}  // namespace
}  // namespace armature::test
