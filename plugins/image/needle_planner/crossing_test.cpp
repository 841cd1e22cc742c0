// SPDX-License-Identifier: Apache-2.0
// Where a line leaves the head, and how aslant.
#include "crossing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "small_head_test.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

constexpr double kTwoDegrees = 2 * std::numbers::pi / 180;

const Volume kHead = SmallHead{}.scan();

TEST(Crossings, AreWhereSkinAndSkullEnd) {
  for (const Vector3d& direction :
       {Vector3d{0, 0, 1}, Vector3d{0.6, 0, 0.8}, Vector3d{1, 2, 2}.normalized()}) {
    const auto crossing = crossing_of(kHead, {0, 0, 0}, direction, 600);
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->skin.norm(), kSmallSkin, 0.0005);
    EXPECT_NEAR(crossing->skull.norm(), kSmallSkull, 0.0006);
    EXPECT_LT(crossing->skull_angle, kTwoDegrees);
  }
}

TEST(Crossings, OfALineOffTheMiddleMeetTheSkullAslant) {
  const Vector3d target{0.02, 0, 0};  // straight up it leaves the skull at asin(20 / 42)
  const auto crossing = crossing_of(kHead, target, {0, 0, 1}, 600);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->skull_angle, std::asin(0.02 / kSmallSkull), kTwoDegrees);
}

TEST(Crossings, EndAtTheSkullAlsoUnderAMarker) {
  SmallHead with_marker;
  with_marker.with(ball({0, 0, kSmallSkin + 0.0025}, 0.002, 2500));
  const auto crossing = crossing_of(with_marker.scan(), {0, 0, 0}, {0, 0, 1}, 600);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->skull.z(), kSmallSkull, 0.0006);
}

TEST(Crossings, WithoutASkullAreNone) {
  EXPECT_FALSE(
      crossing_of(scanned({}, {.size = {20, 20, 20}}, {}), {0.01, 0.01, 0.01}, {0, 0, 1}, 600));
}

}  // namespace
}  // namespace armature::image::needle_planner
