// SPDX-License-Identifier: Apache-2.0
// The ball that holds the head: as large as a round head, larger than one that is not, and without
// markers, table and noise.
#include "head_ball.hpp"

#include <gtest/gtest.h>

#include "small_head_test.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

constexpr double kSmallVoxel = 0.001;  // [m] of the small head

TEST(HeadBalls, HoldARoundHeadWithoutItsMarkersAndTheTable) {
  const Vector3d marker{0, 0, 0.0465};
  SmallHead head;
  head.with(ball(marker, 0.003, 1500))
      .with({Capsule{{-0.045, 0, -0.0485}, {0.045, 0, -0.0485}, 0.0012}, 300});
  const auto found = find_head(head.scan(), {{"marker", marker, marker, 0.006}});
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->name, "head");
  EXPECT_EQ(found->from, found->to);
  EXPECT_LT(found->from.norm(), 0.5 * kSmallVoxel);
  EXPECT_GE(found->radius_m + 0.5 * kSmallVoxel, kSmallSkin);
  EXPECT_LE(found->radius_m, kSmallSkin + 1.5 * kSmallVoxel);
}

TEST(HeadBalls, HoldAHeadThatIsNotRoundByItsFarthestEnds) {
  SmallHead head;
  head.solids = {{Ellipsoid{{0.003, 0, 0}, {0.03, 0.035, 0.044}}, 40}};
  const auto found = find_head(head.scan(), {});
  ASSERT_TRUE(found);
  EXPECT_LT((found->from - Vector3d{0.003, 0, 0}).norm(), kSmallVoxel);
  for (const Vector3d& end :
       {Vector3d{0.003, 0, 0.044}, Vector3d{0.003, 0, -0.044}, Vector3d{0.033, 0, 0}}) {
    EXPECT_LE(clearance(end, end, *found), 0.5 * kSmallVoxel);
  }
  EXPECT_LE(found->radius_m, 0.044 + 1.5 * kSmallVoxel);
}

TEST(HeadBalls, OfAirAreNone) {
  SmallHead air;
  air.solids = {ball({0, 0, 0}, 0.01, -900)};
  EXPECT_EQ(find_head(air.scan(), {}).error().text,
            "no head was found in the volume: it is all air");
}

}  // namespace
}  // namespace armature::image::needle_planner
