// SPDX-License-Identifier: Apache-2.0
#include "bench/bus/bus_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

using testing::HasSubstr;

/// Everything just within its goal in the middle one of three rounds.
class BusReportTest : public testing::Test {
 protected:
  static TripTimes times(double p50_s) { return {.p50_s = p50_s, .p99_s = 2 * p50_s}; }
  static BusRound round(double factor) {
    return {.hand_over_here = times(1e-6),
            .hand_over_across = times(10e-6),
            .hop = times(10e-6 + factor * 4.9e-6),
            .plain_small = times(60e-6),
            .small = times(60e-6 + factor * 39e-6),
            .plain_picture = times(200e-6),
            .picture = times(200e-6 + factor * 29e-6)};
  }
  BusReport report_{.options = {}, .rounds = {round(0), round(1), round(9)}};
};

TEST_F(BusReportTest, ComparesWhatWasMeasuredInTheSameRound) {
  EXPECT_NEAR(median_excess_s(report_, &BusRound::hop, &BusRound::hand_over_across), 4.9e-6, 1e-12);
  EXPECT_NEAR(median_ratio(report_, &BusRound::picture, &BusRound::plain_picture), 1.145, 1e-9);
  EXPECT_TRUE(is_met(report_));
}

TEST_F(BusReportTest, MissesAGoalThatOnePartMisses) {
  const auto missed = [&](TripTimes BusRound::*part, double more_s) {
    BusReport report = report_;
    for (BusRound& round : report.rounds) (round.*part).p50_s += more_s;
    return !is_met(report) && table(report).find("MISSED") != std::string::npos;
  };
  EXPECT_TRUE(missed(&BusRound::hop, 0.2e-6));
  EXPECT_TRUE(missed(&BusRound::small, 1.1e-6));
  EXPECT_TRUE(missed(&BusRound::picture, 1.1e-6));
}

TEST_F(BusReportTest, SaysWhatWasMeasuredAndWhatIsMet) {
  const std::string text = table(report_);
  EXPECT_THAT(text, HasSubstr("a hop takes 4.9 us longer than to wake a thread (goal 5): met"));
  EXPECT_THAT(text, HasSubstr("1.15 times as long (goal 1.15): met"));
  const auto json = nlohmann::json::parse(to_json(report_));
  EXPECT_EQ(json["rounds"].size(), 3U);
  EXPECT_TRUE(json["met"]);
}

}  // namespace
}  // namespace armature::bench
