// SPDX-License-Identifier: Apache-2.0
// Which way the drill goes, and the implants.
#include "site_way.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class SiteWayTest : public testing::Test {
 protected:
  SiteWayTest() {
    chain_.base_T_tracker = Eigen::Translation3d{-1, 0.5, 1.2} *
                            Eigen::AngleAxisd{1.8, Vector3d{0.3, 1, 0.2}.normalized()};
    chain_.flange_T_body =
        Eigen::Translation3d{0.06, -0.03, 0.08} * Eigen::AngleAxisd{0.4, Vector3d::UnitZ()};
    chain_.tip = {0.01, 0.02, 0.1};
    chain_.flange_R_tool = file_tool_.linear();
    chain_.tracker_T_patient = Eigen::Translation3d{0.1, 0.2, 1.5} * Eigen::Quaterniond::Identity();
    chain_.patient_T_image = Eigen::Affine3d{Eigen::Translation3d{0.03, 0, 0}};
    for (const double x : {0.0, 0.012, 0.025}) {
      sites_.emplace_back(Eigen::Translation3d{x, 0, 0.01} *
                          Eigen::AngleAxisd{20 * x, Vector3d::UnitX()});
    }
  }
  /// Where the true drill is in the image when the file's tool is at `pose`.
  Isometry3d drill_in_image(const ToolPose& pose) const {
    const Isometry3d base_T_tool =
        Eigen::Translation3d{pose.position} * std::get<Eigen::Quaterniond>(pose.orientation);
    const Isometry3d base_T_drill = base_T_tool * file_tool_.inverse() * chain_.flange_T_tool();
    return chain_.base_T_site(Isometry3d::Identity()).inverse() * base_T_drill;
  }
  void expect_at(const ToolPose& pose, std::size_t site, double above_m) const {
    const Isometry3d wanted = sites_[site] * Eigen::Translation3d{0, 0, -above_m};
    EXPECT_LT((drill_in_image(pose).matrix() - wanted.matrix()).norm(), 1e-12);
  }

  const Isometry3d file_tool_ =
      Eigen::Translation3d{0, 0.02, 0.15} * Eigen::AngleAxisd{0.5, Vector3d::UnitY()};
  GuidedChain chain_;
  std::vector<Isometry3d> sites_;
};

TEST_F(SiteWayTest, GoesThroughAllSitesInOneMotion) {
  const SiteWay way = drilling_way(chain_, file_tool_, sites_, {.auto_confirm = true});
  expect_at(way.above[0], 0, 0.03);
  ASSERT_EQ(way.passes.size(), 1u);
  EXPECT_FALSE(way.passes[0].ends_at_bottom);
  EXPECT_EQ(way.passes[0].name, "sites 1 to 3");
  const auto& through = way.passes[0].goal.through;
  ASSERT_EQ(through.size(), 7u);
  expect_at(through[0], 0, 0);
  expect_at(through[1], 0, 0.03);
  expect_at(through[2], 1, 0.03);
  expect_at(through[3], 1, 0);
  expect_at(through[4], 1, 0.03);
  expect_at(through[5], 2, 0.03);
  expect_at(through[6], 2, 0);
  expect_at(way.passes[0].goal.pose, 2, 0.03);
}

TEST_F(SiteWayTest, OrEndsAMotionAtEveryBottomAndAboveIt) {
  for (const bool stop_at_sites : {true, false}) {  // an operator who is asked is reason enough
    const SiteWay way = drilling_way(
        chain_, file_tool_, sites_,
        {.stand_off = 0.02, .stop_at_sites = stop_at_sites, .auto_confirm = stop_at_sites});
    ASSERT_EQ(way.passes.size(), 6u);
    for (std::size_t i = 0; i < 3; ++i) {
      const Pass &in = way.passes[2 * i], &out = way.passes[2 * i + 1];
      EXPECT_TRUE(in.ends_at_bottom);
      EXPECT_EQ(in.site, i);
      EXPECT_EQ(out.site, i);
      expect_at(in.goal.pose, i, 0);
      EXPECT_FALSE(out.ends_at_bottom);
      expect_at(out.goal.pose, i, 0.02);
      EXPECT_TRUE(out.goal.through.empty());
      EXPECT_TRUE(way_in(way, way.above[i].position, in).through.empty());
      const auto through = way_in(way, way.above[i == 0 ? 1 : i - 1].position, in).through;
      ASSERT_EQ(through.size(), 1u) << "from above another site first above its own";
      expect_at(through[0], i, 0.02);
    }
    const auto over_site_2 = way_in(way, way.above[2].position, way.passes[0]).through;
    ASSERT_EQ(over_site_2.size(), 2u);
    expect_at(over_site_2[0], 1, 0.02);
    expect_at(over_site_2[1], 0, 0.02);
    EXPECT_EQ(way.passes[2].name, "site 2");
    EXPECT_EQ(way.passes[5].name, "out of site 3");
  }
}

TEST_F(SiteWayTest, LeadsOutOfTheBoneAndBackOverTheSitesThatItCameBy) {
  const SiteWay way = drilling_way(chain_, file_tool_, sites_, {.auto_confirm = true});
  const Vector3d bottom = way.passes[0].goal.through[6].position;
  const MotionGoal out = way_out(way, bottom, 0);
  ASSERT_EQ(out.through.size(), 2u);
  expect_at(out.through[0], 2, 0.03);
  expect_at(out.through[1], 1, 0.03);
  expect_at(out.pose, 0, 0.03);
  const MotionGoal up = way_out(way, bottom, 2);
  EXPECT_TRUE(up.through.empty());
  expect_at(up.pose, 2, 0.03);
  EXPECT_EQ(way_out(way, way.above[1].position, 0).through.size(), 0u)
      << "where it stands it does not go to";
  EXPECT_TRUE(is_above(way, way.above[1].position, 1));
  EXPECT_FALSE(is_above(way, bottom, 2));
}

/// The stand-off of a deeper neighbour is nearer to the bottom of a bore than the bore's own.
TEST_F(SiteWayTest, LeadsStraightOutOfTheBoreThatTheToolIsInWhereverANeighbourHasItsStandOff) {
  for (const bool second : {false, true}) {
    SCOPED_TRACE(second ? "in the second bore" : "in the first bore");
    sites_ = {Isometry3d{Eigen::Translation3d{0, 0, second ? 0.0015 : 0}},
              Isometry3d{Eigen::Translation3d{0.008, 0, second ? 0 : 0.0015}}};
    const SiteWay way = drilling_way(chain_, file_tool_, sites_, {.auto_confirm = true});
    const MotionGoal& pass = way.passes[0].goal;
    const MotionGoal out = way_out(way, pass.through[second ? 3 : 0].position, 0);
    ASSERT_EQ(out.through.size(), second ? 1u : 0u);
    if (second) expect_at(out.through[0], 1, 0.03);
    expect_at(out.pose, 0, 0.03);
  }
}

TEST_F(SiteWayTest, AnImplantGoesToTheBoneThenSlowlyToItsPlaceAndTheDriverOutWithoutIt) {
  const std::vector<PlannedImplant> implants(3, {0.0005, 0.011, 0.0012});
  const SiteWay way =
      placing_way(chain_, file_tool_, sites_, implants, {.depth = 0.012, .max_turn = 4});
  ASSERT_EQ(way.passes.size(), 9u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Pass &to_bone = way.passes[3 * i], &in = way.passes[3 * i + 1],
               &out = way.passes[3 * i + 2];
    // The driver's tip is where the implant begins, its length above its end.
    expect_at(to_bone.goal.pose, i, 0.012 + 0.011);
    expect_at(in.goal.pose, i, 0.0005 + 0.011);
    expect_at(out.goal.pose, i, 0.03 + 0.011);
    EXPECT_TRUE(to_bone.asks && !to_bone.turns && !to_bone.ends_at_bottom);
    EXPECT_TRUE(in.turns && in.ends_at_bottom && !in.asks);
    EXPECT_FALSE(out.asks || out.turns || out.ends_at_bottom);
    EXPECT_NEAR(in.goal.max_speed, 0.0012 * 4 / (2 * M_PI), 1e-15);
  }
  EXPECT_EQ(way.passes[4].name, "implant 2");
}

TEST_F(SiteWayTest, BoresThatComeTooNearAreToldWithBothSitesAndTheDistance) {
  const Parameters parameters{.depth = 0.012, .min_site_distance = 0.007};
  EXPECT_EQ(defect(sites_, parameters), std::nullopt);
  // 8 mm apart at the bottoms; 12 sin(0.1), 1.2 mm, less at the mouths.
  const Isometry3d upright = Isometry3d::Identity();
  const Isometry3d leaning =
      Eigen::Translation3d{0.008, 0, 0} * Eigen::AngleAxisd{0.1, Vector3d::UnitY()};
  const Eigen::Translation3d aside{0, 0.1, 0};
  EXPECT_EQ(defect({sites_[0], aside * upright, aside * leaning}, parameters),
            "the bores of sites 2 and 3 come as near as 6.80 mm to each other, axis to axis; "
            "'min_site_distance_mm' is 7");
  EXPECT_EQ(defect({upright, leaning}, {.depth = 0.009, .min_site_distance = 0.007}), std::nullopt)
      << "8 - 9 sin 0.1 is more than 7";
  const Isometry3d crossing =
      Eigen::Translation3d{-0.003, 0.001, -0.006} * Eigen::AngleAxisd{-M_PI / 2, Vector3d::UnitY()};
  EXPECT_EQ(defect({upright, crossing}, parameters),
            "the bores of sites 1 and 2 come as near as 1.00 mm to each other, axis to axis; "
            "'min_site_distance_mm' is 7");
}

TEST_F(SiteWayTest, ABoreOnTheWayFromOneSiteToTheNextIsToldWithTheSites) {
  const auto site = [](double x, double z) { return Isometry3d{Eigen::Translation3d{x, 0, z}}; };
  const Parameters parameters{.stand_off = 0.024, .depth = 0.012, .min_site_distance = 0.007};
  EXPECT_EQ(defect({site(0, 0.012), site(0.03, 0.012), site(0.015, -0.002)}, parameters),
            "on its way from above site 1 to above site 2 the drill comes as near as 0.00 mm to "
            "the bore of site 3; 'min_site_distance_mm' is 7; drill them in another order, or "
            "raise 'stand_off_mm'");
  EXPECT_EQ(defect({site(0, 0.012), site(0.015, -0.002), site(0.03, 0.012)}, parameters),
            std::nullopt);
}

TEST_F(SiteWayTest, ImplantsThatMeetAboveTheirBoresAreToldWithTheDistance) {
  const Isometry3d upright = Isometry3d::Identity();
  const Isometry3d leaning =
      Eigen::Translation3d{0.008, 0, 0} * Eigen::AngleAxisd{0.1, Vector3d::UnitY()};
  const Parameters parameters{.depth = 0.009, .min_site_distance = 0.007};
  const auto told = [&](double length_m) {
    const PlannedImplant implant{.above_bottom_m = 0.0005, .length_m = length_m, .pitch_m = 0.001};
    return defect({implant, implant}, {upright, leaning}, parameters);
  };
  EXPECT_EQ(told(0.009), std::nullopt);
  EXPECT_EQ(
      told(0.02),
      "implants 1 and 2, which stand above their bores, come as near as 5.95 mm to each other, "
      "axis to axis; 'min_site_distance_mm' is 7");
}

TEST_F(SiteWayTest, OneSiteIsEnough) {
  sites_.resize(1);
  const SiteWay way = drilling_way(chain_, file_tool_, sites_, {.auto_confirm = true});
  ASSERT_EQ(way.passes.size(), 1u);
  EXPECT_EQ(way.passes[0].name, "site 1");
  ASSERT_EQ(way.passes[0].goal.through.size(), 1u);
  expect_at(way.passes[0].goal.through[0], 0, 0);
  expect_at(way.passes[0].goal.pose, 0, 0.03);
}

}  // namespace
}  // namespace armature::task::implant
