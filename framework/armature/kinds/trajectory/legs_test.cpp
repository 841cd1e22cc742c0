// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/legs.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace armature {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

JointVector pair(double first, double second) { return Eigen::Vector2d{first, second}; }

/// Both joints, first one and then the other, in two segments that are one leg.
TrajectoryRequest over_a_via(const JointVector& max_velocity) {
  const JointVector zero = pair(0, 0);
  return {.goal_id = 1,
          .start = Time{},
          .from = {zero, zero, zero},
          .segments = {{.s = {0, 0.5, 1},
                        .q = {zero, pair(0.3, 0), pair(1, 0)},
                        .stop_at_end = false,
                        .duration_s = {}},
                       {.s = {0, 0.5, 1},
                        .q = {pair(1, 0), pair(1, 0.4), pair(1, 1)},
                        .stop_at_end = true,
                        .duration_s = {}}},
          .max_velocity = max_velocity,
          .max_acceleration = pair(1, 1)};
}

TEST(Legs, OfAJointThatMayBeAsFastAsItLikesMove) {
  for (const JointVector& limits : {pair(1, 1), pair(1e13, 1e13), pair(kNoLimit, kNoLimit),
                                    pair(1, kNoLimit), pair(kNoLimit, 1), pair(1, 1e13)}) {
    const auto legs = legs_of(over_a_via(limits));
    ASSERT_TRUE(legs) << legs.error().text;
    ASSERT_EQ(legs->size(), 1u) << limits.transpose();
    EXPECT_TRUE(legs->front().moves) << limits.transpose();
    const JointCurve& curve = legs->front().curve;
    ASSERT_EQ(curve.waypoints().size(), 5u) << limits.transpose();
    EXPECT_EQ(curve.waypoints()[2], pair(1, 0));
    EXPECT_EQ(curve.waypoints()[4], pair(1, 1));
  }
}

std::string defect_when(void (*spoil)(JointSegment&)) {
  TrajectoryRequest request = over_a_via(pair(1, 1));
  request.segments.pop_back();
  request.segments[0].stop_at_end = true;
  spoil(request.segments[0]);
  return defect_of(request);
}

TEST(Legs, OfASegmentWhosePlacesDoNotGoFromZeroToOneAreRefused) {
  const std::string reason = "segment 1 has an s that does not go from 0 to 1";
  EXPECT_EQ(defect_when([](JointSegment&) {}), "");
  EXPECT_EQ(defect_when([](auto& segment) { segment.s = {-kNoLimit, 0, 1}; }), reason);
  EXPECT_EQ(defect_when([](auto& segment) { segment.s = {0, 1, kNoLimit}; }), reason);
  EXPECT_EQ(defect_when([](auto& segment) { segment.s = {7, 8, 11}; }), reason);
  EXPECT_EQ(defect_when([](auto& segment) { segment.s[1] = 0; }),
            "segment 1 has waypoints whose s does not ascend");
  EXPECT_EQ(defect_when([](auto& segment) { segment.s[1] = NAN; }),
            "segment 1 has waypoints whose s does not ascend");
}

TEST(Legs, OfSegmentsThatDoNotMeetAreRefusedAsTheCheckOfTrajectoriesWould) {
  EXPECT_EQ(defect_when([](auto& segment) { segment.q[0][1] = 0.9e-7; }), "");
  EXPECT_EQ(defect_when([](auto& segment) { segment.q[0][1] = 5e-7; }),
            "segment 1 starts 5e-07 away from where it should");
}

TEST(Legs, OfASegmentThatLastsNoTimeOrForEverAreRefused) {
  EXPECT_EQ(defect_when([](auto& segment) { segment.duration_s = 0; }), "segment 1 lasts no time");
  EXPECT_EQ(defect_when([](auto& segment) { segment.duration_s = kNoLimit; }),
            "segment 1 lasts for ever");
}

}  // namespace
}  // namespace armature
