// SPDX-License-Identifier: Apache-2.0
// `armature bench bus`: topics beside Fast DDS alone. On a machine that is busy with tests its
// times mean nothing; that every question is answered, and nobody complains, does.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

TEST(BenchBus, MeasuresTopicsBesideFastDdsAlone) {
  const CommandResult result = run_command({armature(), "bench", "bus", "--rounds", "1", "--domain",
                                            std::to_string(unique_dds_domain()), "--json"},
                                           {}, std::chrono::seconds{60});
  ASSERT_THAT(result.exit_code, testing::AnyOf(0, 1)) << result.err;
  EXPECT_EQ(result.err, "");
  const auto report = nlohmann::json::parse(result.out);
  ASSERT_EQ(report["rounds"].size(), 1U);
  EXPECT_EQ(report["rounds"][0].size(), 7U);
  for (const auto& [part, times] : report["rounds"][0].items()) {
    EXPECT_GT(times["p50_s"], 0) << part;
    EXPECT_GE(times["p99_s"], times["p50_s"]) << part;
  }
}

}  // namespace
}  // namespace armature::test
