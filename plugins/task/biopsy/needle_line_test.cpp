// SPDX-License-Identifier: Apache-2.0
// The plan of a needle: 1. which one is none, with the figures, 2. what is kept away from.
#include "needle_line.hpp"

#include <gtest/gtest.h>

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;

constexpr double kMaxEntryDepth = 0.005;  // [m]

/// A needle from above into a ball of 80 mm about the origin.
NeedleLine into_a_head() {
  return {.entry = {0, 0, 0.081},
          .target = {0, 0, 0.02},
          .forbidden = {{"artery", {0.02, 0, 0}, {0.02, 0.03, 0}, 0.002}},
          .head = {{"head", {0, 0, 0}, {0, 0, 0}, 0.08}}};
}

std::string defect_of(const NeedleLine& plan) { return defect(plan, kMaxEntryDepth).value_or(""); }

TEST(NeedleLines, IntoAHeadAreSound) {
  EXPECT_EQ(defect_of(into_a_head()), "");
  NeedleLine deeper = into_a_head();
  deeper.entry.z() = 0.0751;
  EXPECT_EQ(defect_of(deeper), "") << "a ball that is larger than the head";
}

TEST(NeedleLines, WhoseEntryAndTargetDoNotFitTheHeadAreRefusedWithFigures) {
  NeedleLine swapped = into_a_head();
  std::swap(swapped.entry, swapped.target);
  EXPECT_EQ(defect_of(swapped), "the target is 1.0 mm outside of the head");
  swapped.target.z() = 0.07;
  EXPECT_EQ(defect_of(swapped),
            "the entry is 60.0 mm deep in the head and the target 10.0 mm: are they exchanged?");
  NeedleLine deep = into_a_head();
  deep.entry.z() = 0.0745;
  EXPECT_EQ(defect_of(deep),
            "the entry is 5.5 mm deep in the head, 5 mm are allowed (max_entry_depth_mm): the "
            "needle would not stop before the skin");
  NeedleLine in_air = into_a_head();
  in_air.target.z() = 0.2;
  EXPECT_EQ(defect_of(in_air), "the target is 120.0 mm outside of the head");
  NeedleLine nowhere = into_a_head();
  nowhere.target = nowhere.entry;
  EXPECT_EQ(defect_of(nowhere), "entry and target are one point");
  nowhere.target.z() = NAN;
  EXPECT_EQ(defect_of(nowhere), "entry and target are one point");
}

TEST(NeedleLines, WithoutAHeadAreRefused) {
  NeedleLine plan = into_a_head();
  plan.head[0].radius_m = 0;
  const std::string empty = defect_of(plan);
  plan.head.clear();
  EXPECT_EQ(defect_of(plan), empty);
  EXPECT_EQ(empty,
            "the plan does not say where the head is (head: balls or capsules that hold all of "
            "it), and nothing would keep arm and needle out of it");
  plan.head = {{"skull", {0, 0, 0}, {0, 0, NAN}, 0.08}};
  EXPECT_EQ(defect_of(plan), "the plan's head: forbidden zone 'skull' is not finite");
}

TEST(NeedleLines, OfAHeadInPartsAreAsDeepAsInTheDeepestOfThem) {
  NeedleLine plan = into_a_head();
  plan.head.push_back({"jaw", {0, 0.05, -0.1}, {0, 0.05, -0.1}, 0.06});
  EXPECT_EQ(defect_of(plan), "");
  plan.target = {0, 0.05, -0.1};
  EXPECT_EQ(defect_of(plan), "") << "in the jaw alone";
}

TEST(NeedleLines, BeforeTheRobotKeepVesselsAndHeadWithThemLargerByTheError) {
  const Eigen::Affine3d robot_T_image{Eigen::Translation3d{0.4, 0, 0.2} *
                                      Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitX()}};
  NeedleLine plan = into_a_head();
  plan.head[0].to = {0, 0, -0.02};
  const NeedleLine there = registered(plan, robot_T_image, 0.0007);
  EXPECT_LT((there.target - Vector3d{0.4, -0.02, 0.2}).norm(), 1e-15);
  EXPECT_LT((there.forbidden[0].to - Vector3d{0.42, 0, 0.23}).norm(), 1e-15);
  EXPECT_LT((there.head[0].to - Vector3d{0.4, 0.02, 0.2}).norm(), 1e-15);
  const std::vector<ForbiddenZone> zones = zones_of(there);
  ASSERT_EQ(zones.size(), 2u);
  EXPECT_FALSE(zones[0].tool_enters) << "a vessel";
  EXPECT_TRUE(zones[1].tool_enters) << "the head";
  EXPECT_NEAR(zones[0].radius_m, 0.0027, 1e-15);
  EXPECT_EQ(zones[0].name, "artery (made 0.70 mm larger by the error of the registration)");
  EXPECT_NEAR(zones[1].radius_m, 0.0807, 1e-15);
}

}  // namespace
}  // namespace armature::task::biopsy
