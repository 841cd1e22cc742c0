// SPDX-License-Identifier: Apache-2.0
#include "sweep/spread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "sweep/sweep_report.hpp"

namespace armature::sweep {
namespace {

using Json = nlohmann::ordered_json;
using Statistic = SweepGoal::Statistic;

class SpreadTest : public testing::Test {
 protected:
  /// Runs with error_mm 1 to `count`.
  void add_runs(int count) {
    for (int i = 1; i <= count; ++i) reports_.push_back({{"status", "ok"}, {"error_mm", i}});
  }
  void ask(Statistic statistic, std::optional<double> at_least, std::optional<double> at_most,
           double share_of = 0) {
    config_.sweep_goals.push_back({.metric = "error_mm",
                                   .statistic = statistic,
                                   .at_least = at_least,
                                   .at_most = at_most,
                                   .share_of = share_of,
                                   .origin = {}});
  }
  RunSpread spread() const {
    std::vector<SeedReport> reports;
    for (const Json& report : reports_) reports.push_back({reports.size() + 1, &report});
    return spread_of(reports, config_, {});
  }

  DeploymentConfig config_;
  std::vector<Json> reports_;
};

TEST_F(SpreadTest, TellsMedianP95GreatestAndRms) {
  add_runs(101);
  const RunSpread told = spread();
  const Spread& error = told.figures.at(0);
  EXPECT_EQ(error.median(), 51);
  EXPECT_EQ(error.p95(), 96);
  EXPECT_EQ(error.max(), 101);
  EXPECT_NEAR(error.rms(), std::sqrt(102.0 * 203 / 6), 1e-9);
}

TEST_F(SpreadTest, AGoalOfOneRunIsCountedAndDoesNotDecideWhereThereAreSweepGoals) {
  add_runs(100);
  config_.goals = {{.metric = "error_mm", .limit = 90, .origin = {}}};
  for (std::size_t i = 90; i < 100; ++i) reports_[i]["status"] = "goals_missed";
  EXPECT_EQ(spread().figures.at(0).met, 90u);
  EXPECT_FALSE(spread().is_ok()) << "without sweep goals every run must be ok";
  ask(Statistic::share, 0.85, 0.95, 90);
  EXPECT_TRUE(spread().is_ok());
  reports_[0]["status"] = "fault";
  EXPECT_FALSE(spread().is_ok());
  EXPECT_EQ(spread().failed.at(0).seed, 1u);
  EXPECT_EQ(spread().failed.at(0).status, "fault");
}

TEST_F(SpreadTest, EverySweepGoalIsHeldAgainstItsBoundsOnBothSides) {
  add_runs(100);
  ask(Statistic::p95, {}, 94.9);
  ask(Statistic::median, 50, 51);
  ask(Statistic::max, {}, 99);
  ask(Statistic::share, 0.5, {}, 49);
  ask(Statistic::share, 0.48, 0.5, 49);
  const auto goals = spread().goals;
  EXPECT_EQ(goals[0].fault, "at most 94.9");
  EXPECT_EQ(goals[1].fault, "");
  EXPECT_EQ(goals[2].fault, "at most 99");
  EXPECT_EQ(goals[3].fault,
            "at least 0.5; 100 runs are too few to tell, it is between 0.394 and 0.587");
  EXPECT_EQ(goals[4].fault, "");
}

TEST_F(SpreadTest, ARunThatDidNotMeasureMeetsNothing) {
  add_runs(3);
  reports_.push_back({{"status", "goals_missed"}, {"error_mm", nullptr}});
  reports_.push_back({{"status", "crashed"}});
  ask(Statistic::max, {}, 10);
  ask(Statistic::share, 0.7, {}, 10);
  const auto goals = spread().goals;
  EXPECT_EQ(goals[0].fault, "2 of 5 runs did not measure it");
  EXPECT_EQ(goals[1].fault.substr(0, 12), "at least 0.7") << "3 of 5";
  EXPECT_NEAR(goals[1].value, 0.6, 1e-12);
}

TEST_F(SpreadTest, AFigureThatNoRunMeasuredIsNoGoalMet) {
  reports_.push_back({{"status", "ok"}, {"error_mm", nullptr}});
  ask(Statistic::max, {}, 10);
  EXPECT_EQ(spread().goals[0].fault, "no run measured it");
}

TEST_F(SpreadTest, AGoalIsHeldAgainstEveryComponentThatTellsItsMetric) {
  reports_.push_back({{"status", "goals_missed"}, {"left.error_mm", 12}, {"right.error_mm", 1}});
  config_.goals = {{.metric = "error_mm", .limit = 10, .origin = {}}};
  ask(Statistic::max, {}, 10);
  const RunSpread told = spread();
  ASSERT_EQ(told.goals.size(), 2U);
  EXPECT_EQ(told.goals[0].goal.metric, "left.error_mm");
  EXPECT_EQ(told.goals[0].fault, "at most 10");
  EXPECT_EQ(told.goals[1].fault, "");
  EXPECT_EQ(told.figures.at(1).met, 1U);
}

TEST_F(SpreadTest, ARunThatAFigureDoesNotApplyToIsNotCounted) {
  add_runs(3);
  const Json without{{"status", "ok"},
                     {"error_mm", nullptr},
                     {"does_not_apply", {{"error_mm", "nothing turned"}}}};
  reports_.push_back(without);
  ask(Statistic::max, {}, 3);
  ask(Statistic::share, 1, {}, 3);
  config_.goals = {{.metric = "error_mm", .limit = 3, .origin = {}}};
  const RunSpread told = spread();
  EXPECT_TRUE(told.is_ok());
  EXPECT_EQ(told.figures.at(0).runs(), 3u);
  EXPECT_EQ(told.figures.at(0).inapplicable, 1u);
  EXPECT_EQ(told.goals[1].value, 1) << "3 of 3";
  EXPECT_NE(to_text(told).find("  does not apply to 1 more\n"), std::string::npos) << to_text(told);
  reports_.assign(2, without);
  const RunSpread none = spread();
  EXPECT_TRUE(none.is_ok());
  EXPECT_NE(to_text(none).find("  error_mm, max: does not apply to any run\n"), std::string::npos)
      << to_text(none);
  EXPECT_FALSE(to_json(none)["sweep_goals"][0].contains("met"));
}

TEST(ShareInterval, IsWilsons) {
  const Bounds half = share_interval(50, 100);
  EXPECT_NEAR(half.low, 0.4038, 1e-4);
  EXPECT_NEAR(half.high, 0.5962, 1e-4);
  EXPECT_NEAR(share_interval(10, 10).low, 0.7225, 1e-4);
  EXPECT_NEAR(share_interval(10, 10).high, 1, 1e-12);
}

TEST(QuantileInterval, HoldsTheTrueQuantileInNineteenOfTwentySweeps) {
  SCOPED_TRACE("seed 7");
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> even{0, 1};
  for (const std::size_t runs : {5, 20, 73, 200}) {
    int held = 0;
    for (int sweep = 0; sweep < 2000; ++sweep) {
      std::vector<double> values(runs);
      for (double& value : values) value = even(random);
      std::sort(values.begin(), values.end());
      const QuantileInterval interval = quantile_interval(values, 0.95);
      held += interval.low.value_or(0) <= 0.95 && 0.95 <= interval.high.value_or(1);
    }
    EXPECT_GT(held, 2000 * 0.94) << runs;
  }
}

TEST(QuantileInterval, HasNoUpperBoundBeforeThereAreSeventyThreeRuns) {
  std::vector<double> values;
  for (int i = 0; i < 71; ++i) values.push_back(i);
  EXPECT_FALSE(quantile_interval(values, 0.95).high);
  for (int i = 71; i < 73; ++i) values.push_back(i);
  EXPECT_EQ(quantile_interval(values, 0.95).high, 72);
  EXPECT_FALSE(quantile_interval({1.0}, 0.95).high);
}

}  // namespace
}  // namespace armature::sweep
