// SPDX-License-Identifier: Apache-2.0
// How near a drill came to its bottoms.
#include "bottom_watch.hpp"

#include <gtest/gtest.h>

#include "armature/robot/geometry/guided_chain.hpp"

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class BottomWatchTest : public testing::Test {
 protected:
  BottomWatchTest() {
    chain_.base_T_tracker = Eigen::Translation3d{-1, 0.5, 1.2} *
                            Eigen::AngleAxisd{1.8, Vector3d{0.3, 1, 0.2}.normalized()};
    chain_.flange_T_body =
        Eigen::Translation3d{0.06, -0.03, 0.08} * Eigen::AngleAxisd{0.4, Vector3d::UnitZ()};
    chain_.tip = {0.01, 0.02, 0.1};
    for (const double x : {0.0, 0.012, 0.025}) {
      sites_.emplace_back(Eigen::Translation3d{x, 0, 0.01} *
                          Eigen::AngleAxisd{20 * x, Vector3d::UnitX()});
    }
    std::vector<Destination> bottoms;
    for (const Isometry3d& site : sites_) {
      bottoms.push_back(
          {chain_.flange_T_tool().translation(), chain_.base_T_site(site).translation()});
    }
    watch_ = BottomWatch{bottoms, "the drill", "the bottom of"};
  }
  /// The drill down into a site and out again, by samples, up to `short_m` before its bottom.
  void drill(std::size_t site, double short_m) {
    for (const double above_m : {0.03, 0.01, 0.002, 0.0, 0.002, 0.01, 0.03}) {
      const Eigen::Translation3d up{0, 0, -above_m - short_m};
      watch_.see(chain_.base_T_flange(sites_[site] * up));
    }
  }

  GuidedChain chain_;
  std::vector<Isometry3d> sites_;
  BottomWatch watch_;
};

TEST_F(BottomWatchTest, ADrillThatWasAtEveryBottomMissedNone) {
  for (std::size_t i = 0; i < 3; ++i) drill(i, 0);
  EXPECT_EQ(watch_.missed(3, 1e-9), std::nullopt);
}

TEST_F(BottomWatchTest, TheSiteThatWasMissedByMostIsTold) {
  drill(0, 0.0005);
  drill(1, 0.00313);
  drill(2, 0.0012);
  EXPECT_EQ(watch_.missed(3, 0.0003),
            "the drill came no nearer than 3.13 mm to the bottom of site 2, 0.3 mm are allowed");
  EXPECT_EQ(watch_.missed(1, 0.0003),
            "the drill came no nearer than 0.50 mm to the bottom of site 1, 0.3 mm are allowed");
  EXPECT_EQ(watch_.missed(1, 0.0006), std::nullopt);
}

TEST_F(BottomWatchTest, SitesThatAreNotDrilledYetDoNotCount) {
  drill(0, 0);
  EXPECT_EQ(watch_.missed(0, 0), std::nullopt);
  EXPECT_EQ(watch_.missed(1, 0.0003), std::nullopt);
  EXPECT_NE(watch_.missed(2, 0.0003), std::nullopt);
}

TEST_F(BottomWatchTest, AnArmThatWasNeverSeenWasNowhere) {
  EXPECT_EQ(watch_.missed(3, 0.0003),
            "the drill came no nearer than inf mm to the bottom of site 1, 0.3 mm are allowed");
}

}  // namespace
}  // namespace armature::task::implant
