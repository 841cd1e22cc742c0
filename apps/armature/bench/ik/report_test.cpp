// SPDX-License-Identifier: Apache-2.0
#include "bench/ik/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

using testing::HasSubstr;

/// 100 solves of 1, 2, ... 100 times `step_s`; one in ten does not reach.
Series steps(const char* plugin, Seeds seeds, double step_s) {
  Series series{plugin, seeds, {}};
  for (int i = 1; i <= 100; ++i) {
    series.solves.push_back({.seconds = i * step_s, .reached = i % 10 != 0, .allocations = 3});
  }
  return series;
}

class ReportTest : public testing::Test {
 protected:
  ReportTest() {
    report.robot = "lamp";
    report.baseline = "ik/slow";
    report.counts_allocations = true;
    report.rows = rows_of(series, report.baseline, 1);
    report.refused = {{"ik/other", "not a lamp arm"}};
  }

  std::vector<Series> series{steps("ik/slow", Seeds::random, 1e-5),
                             steps("ik/fast", Seeds::random, 1e-6),
                             steps("ik/fast", Seeds::near, 5e-7)};
  Report report;
};

TEST_F(ReportTest, ComparesMediansWithTheBaselineFromTheSameSeeds) {
  ASSERT_EQ(report.rows.size(), 3U);
  EXPECT_NEAR(report.rows[0].median_s, 505e-6, 1e-9);
  EXPECT_NEAR(report.rows[0].p99_s, 990.1e-6, 1e-8);
  EXPECT_EQ(report.rows[0].reached, 0.9);
  EXPECT_NEAR(report.rows[1].times_base->middle, 10, 1e-9);
  EXPECT_FALSE(report.rows[2].times_base);  // the baseline was not asked from near seeds
}

TEST_F(ReportTest, TheTableNamesEverySolverAndWhyOneIsNotInTheRace) {
  const std::string text = table(report);
  EXPECT_THAT(text, HasSubstr("times ik/slow [95 %]"));
  EXPECT_THAT(text, HasSubstr("10.00 [10.00, 10.00]"));
  EXPECT_THAT(text, HasSubstr("90.00 %"));
  EXPECT_THAT(text, HasSubstr("ik/other  not served: not a lamp arm"));
}

TEST_F(ReportTest, AsJsonItIsTheSame) {
  const auto json = to_json(report);
  EXPECT_EQ(json["rows"][1]["plugin"], "ik/fast");
  EXPECT_EQ(json["rows"][1]["allocations"], 3);
  EXPECT_EQ(json["refused"][0]["reason"], "not a lamp arm");
}

TEST_F(ReportTest, TheCsvHasALinePerSolve) {
  const std::string csv = csv_of(series);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 301);
  EXPECT_THAT(csv, HasSubstr("\n0,ik/fast,near,5e-07,1,0,"));
}

TEST_F(ReportTest, ThePlotHasALinePerSeriesNearSeedsDashed) {
  const std::string svg = plot_of(report, series);
  EXPECT_THAT(svg, HasSubstr("ik/slow, random seeds"));
  EXPECT_THAT(svg, HasSubstr("ik/fast, near seeds"));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

}  // namespace
}  // namespace armature::bench
