// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/loop_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

using testing::HasSubstr;

LoopRound round(double p999_a_s, double p999_b_s) {
  LoopRound made;
  made.a.lateness = {.count = 1000, .p999_s = p999_a_s, .max_s = 2 * p999_a_s};
  made.b.lateness = {.count = 1000, .p999_s = p999_b_s, .max_s = 2 * p999_b_s};
  return made;
}

/// Two twins that differ by a fifth, and our loop beside one: 1.2, 1.5 and 3 times as late.
class LoopReportTest : public testing::Test {
 protected:
  LoopReport report_{
      .options = {.readers = 0, .rounds = 3},
      .notes = {"executor 'control' runs without priority 80"},
      .noise = {round(12e-6, 10e-6), round(12e-6, 10e-6), round(5e-6, 10e-6)},
      .watched = {{.readers = 4,
                   .rounds = {round(12e-6, 10e-6), round(30e-6, 10e-6), round(15e-6, 10e-6)}}}};
};

TEST_F(LoopReportTest, ComparesTheMedianOfItsRatiosWithThatOfTwoTwins) {
  EXPECT_DOUBLE_EQ(median_ratio(report_.watched[0].rounds), 1.5);
  EXPECT_DOUBLE_EQ(noise_of(report_), 1.2);
  EXPECT_TRUE(is_met(report_)) << "1.5 is 1.25 times 1.2";
  report_.watched[0].rounds[0] = round(20e-6, 10e-6);
  EXPECT_FALSE(is_met(report_));
}

TEST(LoopRoundTest, HasAtLeastAThousandSteps) {
  EXPECT_EQ(wrong_round({}), "");
  EXPECT_EQ(wrong_round({.seconds = 1, .period_s = 0.001}), "");
  EXPECT_EQ(wrong_round({.seconds = 0.3, .period_s = 0.0003}), "");
  EXPECT_EQ(wrong_round({.seconds = 0.1, .period_s = 0.001}),
            "a round of 0.1 s has 100 steps of 0.001 s, and p99.9 needs 1000: at least 1 s");
  EXPECT_EQ(wrong_round({.seconds = 4, .period_s = 0.1}),
            "a round of 4 s has 40 steps of 0.1 s, and p99.9 needs 1000: at least 100 s");
}

TEST_F(LoopReportTest, NeedNotBeBetterThanATwin) {
  report_.noise = {round(5e-6, 10e-6)};
  EXPECT_EQ(noise_of(report_), 1);
}

TEST_F(LoopReportTest, OneAllocationOrPageFaultIsTooMany) {
  for (std::uint64_t LoopSide::*count : {&LoopSide::page_faults, &LoopSide::allocations}) {
    LoopReport report = report_;
    report.watched[0].rounds[1].a.*count = 1;
    EXPECT_FALSE(is_met(report));
    report.watched[0].rounds[1].a.*count = 0;
    report.watched[0].rounds[1].b.*count = 1;
    EXPECT_TRUE(is_met(report)) << "the twin's are its own";
  }
}

TEST_F(LoopReportTest, TellsRoundsFiguresAndWhatTheSystemDidNotAllow) {
  const std::string text = table(report_);
  EXPECT_THAT(text,
              HasSubstr("executor, 4 readers: median ratio 1.50 (1.25 of the twins', goal "
                        "1.3), greatest lateness 60 us, 0 page faults, 0 allocations: met\n"));
  EXPECT_THAT(text, HasSubstr("note: executor 'control' runs without priority 80\n"));
  const auto json = nlohmann::json::parse(to_json(report_));
  EXPECT_EQ(json["executor"][0]["readers"], 4);
  EXPECT_EQ(json["executor"][0]["rounds"].size(), 3U);
  EXPECT_EQ(json["executor"][0]["rounds"][1]["p999_ratio"], 3.0);
  EXPECT_EQ(json["executor"][0]["met"], true);
  EXPECT_EQ(json["notes"].size(), 1U);
}

}  // namespace
}  // namespace armature::bench
