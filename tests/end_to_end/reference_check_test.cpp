// SPDX-License-Identifier: Apache-2.0
// The check of the recorded reference finds what it is there for.
#include "reference_check.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace armature::test {
namespace {

constexpr double kDuration = 2;                          // [s]
constexpr double kTurn = 0.5;                            // [rad]
constexpr ReferenceLimits kLimits{.velocity = 0.5,       // peak: 15/8 kTurn/T = 0.47
                                  .acceleration = 0.75,  // peak: 5.774 kTurn/T^2 = 0.72
                                  .jerk = 7.5};          // peak: 60 kTurn/T^3 = 3.75

/// Two joints on a minimum-jerk move from rest to rest.
std::vector<ReferenceSample> smooth_move() {
  std::vector<ReferenceSample> samples;
  for (int k = 0; k <= 2000; ++k) {
    const double u = k * kLimits.period_s / kDuration;
    const double q = kTurn * u * u * u * (10 + u * (-15 + 6 * u));
    const double v = kTurn / kDuration * 30 * u * u * (1 - u) * (1 - u);
    const double a = kTurn / (kDuration * kDuration) * 60 * u * (1 - u) * (1 - 2 * u);
    samples.push_back({.ns = 1'000'000LL * k,
                       .q = Eigen::Vector2d{q, -q},
                       .v = Eigen::Vector2d{v, -v},
                       .a = Eigen::Vector2d{a, -a}});
  }
  return samples;
}

/// The same, with something done to every sample from the 701st on.
std::string defect_after(const std::function<void(ReferenceSample&)>& damage) {
  auto samples = smooth_move();
  for (std::size_t k = 700; k < samples.size(); ++k) damage(samples[k]);
  return reference_defect(samples, kLimits).value_or("none");
}

TEST(ReferenceCheck, AcceptsASmoothMove) {
  EXPECT_EQ(reference_defect(smooth_move(), kLimits).value_or("none"), "none");
}

TEST(ReferenceCheck, FindsAJumpOfTenNanoradians) {
  EXPECT_EQ(defect_after([](auto& sample) { sample.q[1] += 1e-8; }).substr(0, 41),
            "at 0.700 s: a jump in position of joint 2");
}

TEST(ReferenceCheck, FindsAJumpInVelocity) {
  EXPECT_EQ(defect_after([](auto& sample) { sample.v[0] += 1e-5; }).substr(0, 41),
            "at 0.700 s: a jump in velocity of joint 1");
}

TEST(ReferenceCheck, FindsAJumpInAcceleration) {
  EXPECT_EQ(defect_after([](auto& sample) { sample.a[0] += 0.02; }).substr(0, 45),
            "at 0.700 s: a jump in acceleration of joint 1");
}

TEST(ReferenceCheck, FindsAStartFromRestInTheMiddleOfAMove) {
  EXPECT_NE(defect_after([](auto& sample) { sample.v.setZero(), sample.a.setZero(); }), "none");
}

TEST(ReferenceCheck, FindsAHole) {
  EXPECT_EQ(defect_after([](auto& sample) { sample.ns += 1'000'000; }),
            "at 0.701 s: 2000000 ns without a sample");
}

TEST(ReferenceCheck, FindsWhatIsTooFastAndWhatIsNoNumber) {
  ReferenceLimits slow = kLimits;
  slow.velocity = 0.4;
  EXPECT_NE(reference_defect(smooth_move(), slow).value_or("").find("velocity of joint 1"),
            std::string::npos);
  EXPECT_NE(defect_after([](auto& sample) { sample.q[0] = std::nan(""); }), "none");
}

}  // namespace
}  // namespace armature::test
