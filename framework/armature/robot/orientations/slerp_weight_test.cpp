// SPDX-License-Identifier: Apache-2.0
// What a slerp weighs its ends with, and how that changes.
#include "armature/robot/orientations/slerp_weight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature {
namespace {

SlerpWeight weight(double k, double theta) {
  const SlerpAngle between{std::cos(theta), std::sin(theta)};
  return {between, k, std::sin(k * theta), std::cos(k * theta), Rates::acceleration};
}

/// With u = cos(theta): d/du = -1 / sin(theta) d/dtheta.
double by_u(double by_theta, double theta) { return -by_theta / std::sin(theta); }

TEST(SlerpWeight, HasTheDerivativesThatItsDifferencesShow) {
  SCOPED_TRACE("seed 4");
  std::mt19937_64 random{4};
  std::uniform_real_distribution<double> part{0, 1}, angle{0.02, 2.5};
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 2000; ++i) {
    const double k = part(random), theta = angle(random);
    SCOPED_TRACE(::testing::Message() << "k " << k << ", theta " << theta);
    const SlerpWeight w = weight(k, theta);
    const auto by_k = [&](double SlerpWeight::*of) {
      return (weight(k + kStep, theta).*of - weight(k - kStep, theta).*of) / (2 * kStep);
    };
    const auto by_theta = [&](double SlerpWeight::*of) {
      const double step = kStep * theta;
      return (weight(k, theta + step).*of - weight(k, theta - step).*of) / (2 * step);
    };
    const auto expect_near = [](double is, double difference) {
      EXPECT_NEAR(is, difference, 1e-6 * (1 + std::abs(is)));
    };
    EXPECT_NEAR(w.w, std::sin(k * theta) / std::sin(theta), 1e-14);
    expect_near(w.w_k, by_k(&SlerpWeight::w));
    expect_near(w.w_kk, by_k(&SlerpWeight::w_k));
    expect_near(w.w_u, by_u(by_theta(&SlerpWeight::w), theta));
    expect_near(w.w_ku, by_u(by_theta(&SlerpWeight::w_k), theta));
    expect_near(w.w_uu, by_u(by_theta(&SlerpWeight::w_u), theta));
  }
}

TEST(SlerpWeight, HasTheSameOnBothSidesOfWhereItIsWorkedOutInAnotherWay) {
  const double theta = std::asin(0.1);
  for (double k = 0; k <= 1; k += 0.05) {
    const SlerpWeight series = weight(k, theta - 1e-13), quotients = weight(k, theta + 1e-13);
    EXPECT_NEAR(series.w_u, quotients.w_u, 1e-12);
    EXPECT_NEAR(series.w_ku, quotients.w_ku, 1e-12);
    EXPECT_NEAR(series.w_uu, quotients.w_uu, 3e-10) << "times the square of u', below 0.01";
  }
}

TEST(SlerpWeight, OfPointsThatAreOneIsThePart) {
  for (const double k : {0.0, 0.3, 1.0}) {
    const SlerpWeight w = weight(k, 0);
    EXPECT_EQ(w.w, k);
    EXPECT_EQ(w.w_k, 1);
    EXPECT_NEAR(w.w_u, -k * (1 - k * k) / 3, 1e-15);
    EXPECT_NEAR(w.w_ku, -(1 - 3 * k * k) / 3, 1e-15);
    EXPECT_NEAR(w.w_uu, k * (1 - k * k) * (4 - k * k) / 15, 1e-15);
  }
}

}  // namespace
}  // namespace armature
