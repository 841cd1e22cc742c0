// SPDX-License-Identifier: Apache-2.0
// Whether an error that is stated of the markers explains how they fit: 1. the limit is exceeded
// once in a million at most, 2. and not much less often, 3. markers with that error pass, whatever
// the method, 4. a smaller statement does not, 5. and the error that they show is theirs.
#include "armature/kinds/registration/explained_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

/// How likely a chi-squared is to be larger, by the recurrence of its degrees of freedom.
double chi_squared_beyond(double value, std::size_t freedom) {
  const bool odd = freedom % 2 != 0;
  double beyond = odd ? std::erfc(std::sqrt(value / 2)) : std::exp(-value / 2);
  for (std::size_t f = odd ? 1 : 2; f < freedom; f += 2) {
    const double half = static_cast<double>(f) / 2;
    beyond += std::exp(half * std::log(value / 2) - value / 2 - std::lgamma(half + 1));
  }
  return beyond;
}

/// A map that leaves `fre_m`, by all markers.
Registration fitting_to(double fre_m, const MarkerPairs& markers) {
  Registration found;
  found.used.assign(markers.image.size(), true);
  found.fre_m = fre_m;
  return found;
}

class ExplainedFit : public testing::Test {
 protected:
  Eigen::Vector3d gauss(double sigma) {
    return {sigma * normal_(random_), sigma * normal_(random_), sigma * normal_(random_)};
  }
  MarkerPairs seen(std::size_t count, double marker_error_m) {
    MarkerPairs markers;
    for (std::size_t i = 0; i < count; ++i) {
      markers.image.push_back(gauss(0.05));
      markers.robot.push_back(kMotion * markers.image.back() +
                              gauss(marker_error_m / std::sqrt(3.0)));
    }
    return markers;
  }
  static double best_fit(const MarkerPairs& markers) {
    return rms_of(rigid_fit(markers.image, markers.robot), markers.image, markers.robot);
  }

  const Eigen::Isometry3d kMotion =
      Eigen::Translation3d{0.4, 0.1, 0.2} * Eigen::AngleAxisd{1.2, Eigen::Vector3d{0, 0.6, 0.8}};
  std::mt19937_64 random_{29};
  std::normal_distribution<double> normal_;
};

TEST_F(ExplainedFit, TheLimitIsExceededOnceInAMillion) {
  for (std::size_t n = 3; n <= 40; ++n) {
    const double per_axis = 1 / std::sqrt(3.0), limit = largest_explained_fit(n, 1);
    const double squares = static_cast<double>(n) * limit * limit / (per_axis * per_axis);
    const double beyond = chi_squared_beyond(squares, 3 * n - 6);
    EXPECT_LT(beyond, 1e-6) << n;
    EXPECT_GT(beyond, 3e-7) << n;
  }
}

TEST_F(ExplainedFit, TheSquaresOfAFitAreTheChiSquaredThatTheLimitTakesThemFor) {
  constexpr int kTrials = 20000;
  for (const std::size_t n : {3u, 4u, 6u}) {
    int beyond = 0;
    const double value = 3.0 * static_cast<double>(n);  // 3 to 12 in a hundred are larger
    for (int i = 0; i < kTrials; ++i) {
      const double fit = best_fit(seen(n, 0.0005)) / (0.0005 / std::sqrt(3.0));
      if (static_cast<double>(n) * fit * fit > value) ++beyond;
    }
    const double expected = chi_squared_beyond(value, 3 * n - 6);
    EXPECT_NEAR(beyond / static_cast<double>(kTrials), expected,
                4 * std::sqrt(expected / kTrials) + 1e-3)
        << n;
  }
}

TEST_F(ExplainedFit, TheErrorThatMarkersShowIsTheirsAndNeverLessThanWhatIsStated) {
  constexpr int kTrials = 20000;
  for (const std::size_t n : {3u, 4u, 6u}) {
    double squares = 0;
    for (int i = 0; i < kTrials; ++i)
      squares += std::pow(shown_marker_error(seen(n, 0.0008), 0), 2);
    EXPECT_NEAR(std::sqrt(squares / kTrials), 0.0008, 0.00001) << n;
    EXPECT_EQ(shown_marker_error(seen(n, 0.0008), 0.1), 0.1) << n;
  }
  EXPECT_EQ(shown_marker_error(seen(2, 0.0008), 0.0001), 0.0001) << "two fit always";
}

TEST_F(ExplainedFit, TwoMarkersSayNothing) {
  const MarkerPairs two = seen(2, 0.01);
  EXPECT_FALSE(unexplained_fit(two, fitting_to(best_fit(two), two), 1e-6));
}

TEST_F(ExplainedFit, AMethodThatDoesNotLookForTheBestFitIsNotBlamedForIt) {
  const MarkerPairs markers = seen(6, 0.0005);
  EXPECT_FALSE(unexplained_fit(markers, fitting_to(0.002, markers), 0.0005));
  EXPECT_FALSE(unexplained_fit(markers, fitting_to(0, markers), 1e-6))
      << "one that takes all error exactly says nothing";
}

TEST_F(ExplainedFit, OnlyMarkersThatDecidedCount) {
  MarkerPairs markers = seen(6, 0.0005);
  markers.robot[2].x() += 0.02;
  Registration found = fitting_to(best_fit(markers), markers);
  EXPECT_TRUE(unexplained_fit(markers, found, 0.0005));
  found.used[2] = false;
  EXPECT_FALSE(unexplained_fit(markers, found, 0.0005));
}

TEST_F(ExplainedFit, AnErrorThatIsStatedTooSmallIsToldWithTheWayOut) {
  const MarkerPairs exact = seen(6, 0);
  MarkerPairs markers = exact;
  for (std::size_t i = 0; i < 6; ++i) markers.robot[i].x() += i % 2 == 0 ? 0.0007 : -0.0007;
  const Registration found = fitting_to(best_fit(markers), markers);
  const double fit_m = found.fre_m;
  const double min_m = fit_m / largest_explained_fit(6, 1);
  EXPECT_FALSE(unexplained_fit(markers, found, 1.001 * min_m));
  EXPECT_TRUE(unexplained_fit(markers, found, 0.999 * min_m));
  EXPECT_TRUE(unexplained_fit(markers, found, 0));
  const auto why = unexplained_fit(markers, found, 0.0001);
  ASSERT_TRUE(why);
  EXPECT_NE(why->find(" mm, which an error of 0.1 mm a marker does not explain (at most 0.17 mm, "
                      "99.9999 %): state the error that they have (marker_error), or look for a "
                      "marker that has moved"),
            std::string::npos)
      << *why;
}

}  // namespace
}  // namespace armature
