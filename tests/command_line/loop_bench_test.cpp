// SPDX-License-Identifier: Apache-2.0
// `armature bench loop`: an executor beside a bare thread. On a machine that is busy with tests its
// times mean nothing; that it neither allocates nor meets page faults does.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "armature/values/sanitizer.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

TEST(BenchLoop, AnExecutorNeitherAllocatesNorMeetsPageFaultsAlsoWhenOthersRead) {
  const CommandResult result =
      run_command({armature(), "bench", "loop", "--rounds", "1", "--seconds", "1", "--readers", "1",
                   "--priority", "0", "--domain", std::to_string(unique_dds_domain()), "--json"});
  ASSERT_THAT(result.exit_code, testing::AnyOf(0, 1)) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  ASSERT_EQ(report["executor"].size(), 2U);
  const bool memory_is_locked = report["notes"].empty() && !kSanitized;
  for (const auto& watched : report["executor"]) {
    EXPECT_EQ(watched["allocations"], 0) << watched.dump();
    if (memory_is_locked) {
      EXPECT_EQ(watched["page_faults"], 0) << watched.dump();
    }
    EXPECT_GT(watched["rounds"][0]["loop"]["steps"], 100);
    EXPECT_GT(watched["rounds"][0]["twin"]["steps"], 100);
  }
  EXPECT_EQ(report["executor"][0]["readers"], 0);
  EXPECT_EQ(report["executor"][1]["readers"], 1);
}

TEST(BenchLoop, RefusesRoundsThatAreTooShortForTheirFigures) {
  const CommandResult result = run_command({armature(), "bench", "loop", "--seconds", "0.1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err,
              testing::HasSubstr("--seconds: a round of 0.1 s has 100 steps of 0.001 s, and p99.9 "
                                 "needs 1000: at least 1 s"));
}

}  // namespace
}  // namespace armature::test
