// SPDX-License-Identifier: Apache-2.0
// How still an arm stands by its own measurement: 1. without noise, 2. with it, 3. on its way.
#include "arm_rest.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class ArmNoiseTest : public testing::Test {
 protected:
  /// At `x` [m], measured with noise along so many axes.
  Isometry3d measured(double x, int axes) {
    std::normal_distribution<double> normal{0, noise_m_};
    Vector3d place{x, 0, 0}, turn = Vector3d::Zero();
    for (int i = 0; i < axes; ++i) place[i] += normal(random_);
    for (int i = 0; i < axes; ++i) turn[i] += 5 * normal(random_);  // [rad]
    const double angle = turn.norm();
    return Eigen::Translation3d{place} *
           Eigen::AngleAxisd{angle, angle > 0 ? Vector3d{turn / angle} : Vector3d::UnitX()};
  }

  double noise_m_ = 0;
  std::mt19937 random_{4};
  ArmNoise noise_;
};

TEST_F(ArmNoiseTest, WithoutNoiseAFewHundredthsOfAMillimetreAreAMotion) {
  for (int i = 0; i < 100; ++i) noise_.see(measured(0, 3));
  EXPECT_FALSE(noise_.stillness().is_left(measured(0, 0), measured(1.9e-5, 0)));
  EXPECT_TRUE(noise_.stillness().is_left(measured(0, 0), measured(2.1e-5, 0)));
}

TEST_F(ArmNoiseTest, AnArmThatStandsIsNotTakenToMoveByItsNoise) {
  for (const int axes : {1, 3}) {
    for (const double noise_m : {3e-6, 1e-5, 2e-5}) {
      noise_m_ = noise_m;
      int moved = 0;
      const Isometry3d rests = measured(0, axes);
      for (int i = 0; i < 20'000; ++i) {
        const Isometry3d now = measured(0, axes);
        noise_.see(now);
        if (i > 31 && noise_.stillness().is_left(rests, now)) ++moved;
      }
      EXPECT_LE(moved, 20) << axes << " axes, " << noise_m;
      EXPECT_TRUE(noise_.stillness().is_left(measured(0, axes), measured(40 * noise_m, axes)));
    }
  }
}

TEST_F(ArmNoiseTest, NoNoiseHidesAMotionThatIsLongerThanTheNoisiestAllowedFor) {
  noise_m_ = 0.01;
  for (int i = 0; i < 100; ++i) noise_.see(measured(0, 3));
  noise_m_ = 0;
  EXPECT_TRUE(noise_.stillness().is_left(measured(0, 0), measured(2.1e-4, 0)));
}

TEST_F(ArmNoiseTest, ASteadyMotionIsNoNoise) {
  double x = 0;
  for (int i = 0; i < 100; ++i) noise_.see(measured(x += 1e-4, 0));
  EXPECT_TRUE(noise_.stillness().is_left(measured(x, 0), measured(x + 2.1e-5, 0)));
}

}  // namespace
}  // namespace armature::task::implant
