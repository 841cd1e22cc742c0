// SPDX-License-Identifier: Apache-2.0
// What came of a bore: 1. the error where the drill was deepest, 2. only at its site, 3. how
// straight it went in.
#include "bore_monitor.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class BoreMonitorTest : public testing::Test {
 protected:
  BoreMonitorTest() {
    truth_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0, 0, 1}};
    estimate_ = truth_;
  }
  /// The true drill at `x`, `z` of the site, z from its bottom [m].
  void see(double x, double z, double tilt = 0) {
    const Isometry3d drill = truth_.base_T_site(site_) * Eigen::Translation3d{x, 0, z} *
                             Eigen::AngleAxisd{tilt, Vector3d::UnitY()};
    monitor_.see(drill * truth_.flange_T_tool().inverse(), estimate_, truth_);
  }

  const Isometry3d site_{Eigen::Translation3d{0.02, 0, 0} *
                         Eigen::AngleAxisd{M_PI, Vector3d::UnitX()}};
  GuidedChain truth_, estimate_;
  BoreMonitor monitor_{site_, 0.012};
};

TEST_F(BoreMonitorTest, TellsTheErrorWhereTheDrillWasDeepest) {
  see(0.0002, -0.02);
  EXPECT_FALSE(monitor_.error()) << "not inside yet";
  see(0.0002, -0.01);
  see(0.0003, 0.0004, 0.02);
  see(0.0009, -0.01);
  ASSERT_TRUE(monitor_.error());
  EXPECT_LT((*monitor_.error() - Vector3d{0.0003, 0, -0.0004}).norm(), 1e-12)
      << "in the base frame: the site's z axis is turned round";
  EXPECT_NEAR(monitor_.axis_error_rad(), 0.02, 1e-9);
}

TEST_F(BoreMonitorTest, ADrillThatPassesBesideIsNotThere) {
  see(0.015, 0.05);
  EXPECT_FALSE(monitor_.error());
  EXPECT_EQ(monitor_.line_deviation_m(), 0);
}

TEST_F(BoreMonitorTest, StraightIsAlongTheAxisAsItWasRegistered) {
  estimate_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0.0005, 0, 1}};
  see(0.0005, -0.01, 0.01);
  see(0.0006, -0.005);
  EXPECT_NEAR(monitor_.line_deviation_m(), 0.0001, 1e-12);
  EXPECT_NEAR(monitor_.line_tilt_rad(), 0.01, 1e-9);
}

}  // namespace
}  // namespace armature
