// SPDX-License-Identifier: Apache-2.0
// `armature bench watched`: a deployment alone, recorded and read. On a machine that is busy with
// tests its times mean nothing; that each way ran, with threads that worked, does.
#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

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
  const auto refusal_of = [](const std::string& assignment) {
    const CommandResult result = bench_watched("configs/dental_lamp.yaml", {"--set", assignment});
    EXPECT_EQ(result.exit_code, 3) << assignment;
    return result.err;
  };
  EXPECT_THAT(refusal_of("components.face.process=vision"),
              testing::HasSubstr("several processes"));
  EXPECT_THAT(refusal_of("clock=simulated"), testing::HasSubstr("--set clock=system"));
  EXPECT_THAT(refusal_of("record.file=x.mcap"), testing::HasSubstr("leave record: out"));
}

TEST(BenchWatched, WhatItHasStartedEndsWithIt) {
  const std::string domain = std::to_string(unique_dds_domain());
  Command bench{{armature(), "bench", "watched", source_file("configs/sr1_biopsy.yaml"), "--set",
                 "clock=system", "--rounds", "1", "--seconds", "60", "--domain", domain}};
  pid_t run = 0;
  for (int i = 0; i < 2000 && run == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
    run = bench.child();
  }
  ASSERT_NE(run, 0) << bench.err();
  bench.signal(SIGKILL);
  EXPECT_TRUE(ends_within(run, std::chrono::seconds{20}));
}

}  // namespace
}  // namespace armature::test
