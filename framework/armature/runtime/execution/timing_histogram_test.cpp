// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/timing_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace armature {
namespace {

class TimingHistogramTest : public testing::Test {
 protected:
  void add(const std::vector<std::int64_t>& ns) {
    for (const std::int64_t one : ns) histogram_.add(Duration{one});
  }
  TimingHistogram histogram_;
};

TEST_F(TimingHistogramTest, OfNothingIsZero) {
  const TimingFigures figures = histogram_.counts().figures();
  EXPECT_EQ(figures.count, 0U);
  EXPECT_EQ(figures.last_s, 0);
  EXPECT_EQ(figures.mean_s, 0);
  EXPECT_EQ(figures.p99_s, 0);
  EXPECT_EQ(figures.max_s, 0);
}

TEST_F(TimingHistogramTest, KnowsCountMeanLastAndGreatestExactly) {
  add({1'000, 5'000'000, 3'000});
  const TimingFigures figures = histogram_.counts().figures();
  EXPECT_EQ(figures.count, 3U);
  EXPECT_DOUBLE_EQ(figures.mean_s, 5'004'000e-9 / 3);
  EXPECT_DOUBLE_EQ(figures.last_s, 3e-6);
  EXPECT_DOUBLE_EQ(figures.max_s, 5e-3);
}

TEST_F(TimingHistogramTest, KnowsQuantilesWithinTheWidthOfABucket) {
  std::mt19937_64 random{1};
  for (const double median_ns : {20.0, 3e3, 4e5, 7e9}) {
    std::lognormal_distribution<double> draw{std::log(median_ns), 0.8};
    auto histogram = std::make_unique<TimingHistogram>();
    std::vector<std::int64_t> all(20000);
    for (std::int64_t& one : all) {
      one = static_cast<std::int64_t>(draw(random));
      histogram->add(Duration{one});
    }
    std::ranges::sort(all);
    const TimingFigures figures = histogram->counts().figures();
    const auto expect_near = [&](double got_s, double part) {
      const auto exact = 1e-9 * static_cast<double>(all[static_cast<std::size_t>(part * 20000)]);
      EXPECT_NEAR(got_s / exact, 1, 1.0 / 16) << median_ns << " at " << part;
    };
    expect_near(figures.p99_s, 0.99);
    expect_near(figures.p999_s, 0.999);
  }
}

TEST_F(TimingHistogramTest, TellsOfAPeriodWhatWasCountedInItAlone) {
  add({1'000'000, 2'000'000});
  const auto before = histogram_.counts();
  EXPECT_EQ(histogram_.counts().figures_since(before).count, 0U);
  add({10'000, 30'000});
  const TimingFigures since = histogram_.counts().figures_since(before);
  EXPECT_EQ(since.count, 2U);
  EXPECT_DOUBLE_EQ(since.mean_s, 20e-6);
  EXPECT_DOUBLE_EQ(since.last_s, 30e-6);
  EXPECT_GE(since.max_s, 30e-6);
  EXPECT_LE(since.max_s, 32e-6) << "to the end of its bucket";
}

TEST_F(TimingHistogramTest, TakesWhateverAClockMayGive) {
  add({-5, 0, std::int64_t{1} << 62});
  const TimingFigures figures = histogram_.counts().figures();
  EXPECT_EQ(figures.count, 3U);
  EXPECT_DOUBLE_EQ(figures.max_s, 1e-9 * static_cast<double>(std::int64_t{1} << 62));
}

}  // namespace
}  // namespace armature
