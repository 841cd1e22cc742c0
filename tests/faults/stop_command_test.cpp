// SPDX-License-Identifier: Apache-2.0
// `armature stop`: it says who has taken the stop, and fails when nobody can have.
#include <gmock/gmock.h>

#include <chrono>

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
  const std::string domain_ = std::to_string(unique_dds_domain());
};

TEST_F(StopCommand, NamesTheDeploymentThatHasStopped) {
  Command run{{armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--set", "clock=system",
               "--domain", domain_},
              {}};
  ASSERT_TRUE(run.wait_for_err("task      approach", kAtMost)) << run.err();
  const CommandResult result = stop("20");
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

TEST_F(StopCommand, FailsWhereOnlyARecorderHearsIt) {
  Command recorder{{armature(), "topic", "echo", "/stop", "--domain", domain_}, {}};
  const CommandResult result = stop("1.5");
  EXPECT_EQ(result.exit_code, kNobodyHeard);
  EXPECT_THAT(result.err, HasSubstr("(pid " + std::to_string(recorder.pid()) + " on "));
  EXPECT_THAT(result.err, HasSubstr("reads /stop, and is no deployment"));
}

}  // namespace
}  // namespace armature::test
