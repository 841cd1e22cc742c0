// SPDX-License-Identifier: Apache-2.0
// `armature bench watched`: a deployment alone, recorded and read. On a machine that is busy with
// tests its times mean nothing; that each way ran, with threads that worked, does.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

CommandResult bench_watched(const std::string& deployment, std::vector<std::string> more) {
  more.insert(more.begin(), {armature(), "bench", "watched", source_file(deployment), "--rounds",
                             "1", "--seconds", "1", "--readers", "1", "--domain",
                             std::to_string(unique_dds_domain()), "--json"});
  return run_command(more, {}, std::chrono::seconds{60});
}

TEST(BenchWatched, RunsADeploymentAloneRecordedAndRead) {
  const CommandResult result = bench_watched("configs/sr1_biopsy.yaml", {"--set", "clock=system"});
  ASSERT_THAT(result.exit_code, testing::AnyOf(0, 1)) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  for (const char* way : {"alone", "recorded", "read"}) {
    ASSERT_EQ(report[way]["runs"].size(), 1U);
    const auto& control = report[way]["runs"][0]["own"]["control"];
    EXPECT_GT(control["processor_s"], 0) << way;
    EXPECT_GT(control["cycles"], 100) << way << ": a thousand a second, where there is time";
  }
}

TEST(BenchWatched, RefusesWhatItCannotMeasure) {
  const CommandResult result =
      bench_watched("configs/dental_lamp.yaml", {"--set", "components.face.process=vision"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, testing::HasSubstr("several processes"));
}

}  // namespace
}  // namespace armature::test
