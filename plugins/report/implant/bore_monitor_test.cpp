// SPDX-License-Identifier: Apache-2.0
// What came of a bore: 1. the error where the drill was deepest, 2. only at its site, also when
// another is near or the error is large, 3. how straight it went in.
#include "bore_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::report::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Two sites 5 mm apart, the second 3 mm deeper in.
class BoreMonitorTest : public testing::Test {
 protected:
  BoreMonitorTest() {
    truth_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0, 0, 1}};
    estimate_ = truth_;
    watch();
  }
  void watch(double near_m = 0.002) {
    monitor_ = BoreMonitor{{{sites_[0]}, {sites_[1]}}, estimate_, {.near = near_m}};
  }
  /// The drill, as the arm believes, at `x`, `z` of the first site, z from its bottom [m].
  void see(double x, double z, double tilt = 0) {
    const Isometry3d drill = estimate_.base_T_site(sites_[0]) * Eigen::Translation3d{x, 0, z} *
                             Eigen::AngleAxisd{tilt, Vector3d::UnitY()};
    monitor_.see(drill * estimate_.flange_T_tool().inverse(), truth_);
  }
  const Bore& bore(std::size_t i) const { return monitor_.bores()[i]; }

  const std::vector<Isometry3d> sites_{
      Eigen::Translation3d{0.02, 0, 0} * Eigen::AngleAxisd{M_PI, Vector3d::UnitX()},
      Eigen::Translation3d{0.025, 0, -0.003} * Eigen::AngleAxisd{M_PI, Vector3d::UnitX()}};
  GuidedChain truth_, estimate_;
  BoreMonitor monitor_{{}, {}, {}};
};

TEST_F(BoreMonitorTest, TellsTheErrorWhereTheDrillWasDeepest) {
  see(0.0002, -0.02);
  EXPECT_FALSE(bore(0).error) << "not inside yet";
  see(0.0002, -0.01);
  see(0.0003, 0.0004, 0.02);
  see(0.0009, -0.01);
  ASSERT_TRUE(bore(0).error);
  EXPECT_LT((*bore(0).error - Vector3d{0.0003, 0, -0.0004}).norm(), 1e-12)
      << "in the base frame: the site's z axis is turned round";
  EXPECT_NEAR(bore(0).axis_error_rad, 0.02, 1e-9);
}

TEST_F(BoreMonitorTest, ADrillThatPassesBesideIsNotThere) {
  see(0.0025, 0.001);
  EXPECT_FALSE(bore(0).error);
  EXPECT_FALSE(bore(1).error);
  EXPECT_EQ(bore(0).line_deviation_m, 0);
}

TEST_F(BoreMonitorTest, ADrillThatLeavesItsBoreSidewaysIsToldHowFarItWent) {
  see(0, -0.001);
  see(-0.004, -0.001);
  EXPECT_NEAR(bore(0).line_deviation_m, 0.004, 1e-12) << "twice what is near";
  see(-0.004, -0.02);
  see(-0.006, -0.001);
  EXPECT_NEAR(bore(0).line_deviation_m, 0.004, 1e-12) << "out above, and elsewhere";
}

TEST_F(BoreMonitorTest, TheDeeperBoreOfANeighbourIsNotThisOne) {
  see(0, 0);
  see(0.005, 0.003);
  ASSERT_TRUE(bore(0).error && bore(1).error);
  EXPECT_NEAR(bore(0).error->norm(), 0, 1e-12);
  EXPECT_NEAR(bore(1).error->norm(), 0, 1e-12);
}

TEST_F(BoreMonitorTest, OfTwoBoresThatAreBothNearItIsInTheNearer) {
  watch(0.01);
  see(0, 0);
  see(0.005, 0.003);
  ASSERT_TRUE(bore(0).error && bore(1).error);
  EXPECT_NEAR(bore(0).error->norm(), 0, 1e-12);
  EXPECT_NEAR(bore(0).line_deviation_m, 0, 1e-12);
  EXPECT_NEAR(bore(1).error->norm(), 0, 1e-12);
}

TEST_F(BoreMonitorTest, ADrillInOneBoreIsNotAtItsNeighbourHoweverMuchIsCalledNear) {
  watch(0.02);
  see(0.005, 0.003);
  see(0.005, -0.01);   // on its way out of the second bore
  see(0.005, -0.011);  // out of it, above the bottom of the first by less than its depth
  EXPECT_FALSE(bore(0).error);
  EXPECT_NEAR(bore(1).near_m, 0.0025, 1e-12);
  see(0.0024, -0.001);
  EXPECT_TRUE(bore(0).error);
}

TEST_F(BoreMonitorTest, TellsOfSitesOnOneAxis) {
  EXPECT_FALSE(monitor_.one_axis());
  const std::vector<Site> sites{
      {sites_[0]}, {sites_[1]}, {sites_[0] * Eigen::Translation3d{0, 0, 0.004}}};
  const auto both = BoreMonitor{sites, estimate_, {}}.one_axis();
  ASSERT_TRUE(both);
  EXPECT_EQ(both->first, 0U);
  EXPECT_EQ(both->second, 2U);
}

TEST_F(BoreMonitorTest, OfAnImplantTheEndCountsWhereverTheDriverIs) {
  monitor_ = BoreMonitor{{{sites_[0], 0.01}, {sites_[1]}}, estimate_, {}};
  see(0, -0.01, 0.02);  // the driver's tip, tilted about it by the estimate's own measure
  ASSERT_TRUE(bore(0).error);
  EXPECT_NEAR(bore(0).error->norm(), 2 * 0.01 * std::sin(0.01), 1e-12);
  EXPECT_NEAR(bore(0).axis_error_rad, 0.02, 1e-12);
}

TEST_F(BoreMonitorTest, ADrillThatMissesByFarIsStillAtTheSiteThatItDrills) {
  estimate_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0, 0.015, 1}};
  watch();
  see(0, 0);
  ASSERT_TRUE(bore(0).error);
  EXPECT_NEAR(bore(0).error->norm(), 0.015, 1e-12);
  EXPECT_NEAR(bore(0).line_deviation_m, 0, 1e-12);
}

TEST_F(BoreMonitorTest, StraightIsAlongTheAxisAsItWasRegistered) {
  estimate_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0.0005, 0, 1}};
  watch();
  see(0, -0.01, 0.01);
  see(0.0001, -0.005);
  EXPECT_NEAR(bore(0).line_deviation_m, 0.0001, 1e-12);
  EXPECT_NEAR(bore(0).line_tilt_rad, 0.01, 1e-9);
}

}  // namespace
}  // namespace armature::report::implant
