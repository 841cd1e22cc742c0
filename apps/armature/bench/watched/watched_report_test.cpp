// SPDX-License-Identifier: Apache-2.0
#include "bench/watched/watched_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

using testing::HasSubstr;

class WatchedReportTest : public testing::Test {
 protected:
  /// Of a thread that makes 100 cycles alone, and half of them when it is read.
  static WatchedRound round(double alone_s, double recorded_s, double read_s) {
    const auto run = [](double processor_s, std::uint64_t cycles) {
      return WatchedRun{.own = {{"control", {.processor_s = processor_s, .cycles = cycles}}},
                        .others_s = 0.1,
                        .lost = 0};
    };
    return {run(alone_s, 100), run(recorded_s, 100), run(read_s / 2, 50)};
  }
  WatchedReport report_{
      .options = {},
      .rounds = {round(0.4, 0.404, 0.41), round(0.5, 0.6, 0.51), round(0.4, 0.4, 0.4)}};
};

TEST_F(WatchedReportTest, ComparesWhatACycleTakesInRunsOfTheSameRound) {
  EXPECT_NEAR(median_ratio(report_, Watching::recorded), 1.01, 1e-9);
  EXPECT_NEAR(median_ratio(report_, Watching::read), 1.02, 1e-9);
  EXPECT_TRUE(is_met(report_));
  report_.rounds[2][1].own["control"].processor_s = 0.5;
  EXPECT_FALSE(is_met(report_));
}

TEST_F(WatchedReportTest, MissesItsGoalWithOneMessageLost) {
  EXPECT_THAT(table(report_), HasSubstr("nothing lost: met"));
  report_.rounds[1][2].lost = 1;
  EXPECT_FALSE(is_met(report_));
  EXPECT_THAT(table(report_), HasSubstr("nothing lost: MISSED"));
  const auto json = nlohmann::json::parse(to_json(report_));
  EXPECT_EQ(json["read"]["lost"], 1);
  EXPECT_FALSE(json["read"]["met"]);
  EXPECT_TRUE(json["recorded"]["met"]);
}

}  // namespace
}  // namespace armature::bench
