// SPDX-License-Identifier: Apache-2.0
// How far off the drill's tip is, over 200 seeds, and what brings it about.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "implant_run.hpp"

namespace armature::test {
namespace {

constexpr int kSeeds = 200;

const std::vector<DeploymentRun>& runs() {
  static const std::vector<DeploymentRun> all = [] {
    std::vector<DeploymentRun> made;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      made.push_back(implant({"seed=" + std::to_string(seed)}));
    }
    return made;
  }();
  return all;
}

/// The value that `part` of all runs stay below.
double quantile(const std::string& figure, double part) {
  std::vector<double> values;
  for (const DeploymentRun& run : runs()) values.push_back(run.figure(figure));
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * (kSeeds - 1))];
}

double rms(const std::string& figure) {
  double sum = 0;
  for (const DeploymentRun& run : runs()) sum += std::pow(run.figure(figure), 2);
  return std::sqrt(sum / kSeeds);
}

TEST(DentalImplantSeeds, EveryRunDrillsAllSites) {
  for (const DeploymentRun& run : runs()) {
    ASSERT_EQ(run.status(), "ok") << run.text();
  }
}

TEST(DentalImplantSeeds, TheTipComesWithinFourTenthsOfAMillimetreAndEightInNinetyFiveOfAHundred) {
  const double median = quantile("site_error_mm", 0.5), bound = quantile("site_error_mm", 0.95);
  std::cout << "the worst of three sites [mm]: median " << median << ", 95 % " << bound
            << ", largest " << quantile("site_error_mm", 1) << "\n";
  EXPECT_LE(median, 0.4);
  EXPECT_LE(bound, 0.8);
}

TEST(DentalImplantSeeds, EverySourceBringsAsMuchAsIsExpectedOfIt) {
  double measured = 0, expected = 0;
  for (const std::string source : {"registration", "hand_eye", "tool", "tracker"}) {
    const double is = rms(source + "_error_mm"), was = rms("expected_" + source + "_error_mm");
    std::cout << source << " [mm]: rms " << is << ", expected " << was << "\n";
    EXPECT_NEAR(is / was, 1, 0.1) << source;
    measured += is * is;
    expected += was * was;
  }
  const double all = rms("site_error_rms_mm");
  std::cout << "together [mm]: rms " << all << ", of the sources in quadrature "
            << std::sqrt(measured) << ", expected " << std::sqrt(expected) << "\n";
  EXPECT_NEAR(std::sqrt(measured) / all, 1, 0.05);
  EXPECT_NEAR(std::sqrt(expected) / all, 1, 0.1);
  EXPECT_LE(quantile("unexplained_error_mm", 1), 0.01);
}

}  // namespace
}  // namespace armature::test
