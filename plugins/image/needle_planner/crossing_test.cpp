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
  with_marker.with(ball({0, 0, kSmallSkin + 0.002}, 0.0015, 2500));
  const Vector3d marker{0, 0, kSmallSkin + 0.002};
  const auto crossing = crossing_of(with_marker.scan(), {0, 0, 0}, {0, 0, 1}, 600,
                                    {{"marker", marker, marker, 0.0045}});
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->skull.z(), kSmallSkull, 0.0006);
}

/// A scalp, and a skull that is thick above and holds the ball of air there.
SmallHead with_air_cell(double radius) {
  SmallHead head;
  head.solids[2] = ball({0, 0, -0.007}, 0.03, 35);
  return head.with(ball({0, 0, 0.032}, radius, kAirHu));
}

TEST(Crossings, AreNoneThroughAnAirCellOfTheSkull) {
  EXPECT_TRUE(crossing_of(with_air_cell(0.0005).scan(), {0, 0, 0}, {0, 0, 1}, 600));
  const Volume head = with_air_cell(0.004).scan();
  EXPECT_FALSE(crossing_of(head, {0, 0, 0}, {0, 0, 1}, 600));
  const Vector3d aside = Vector3d{0.7, 0, 1}.normalized();
  const auto beside = crossing_of(head, {0, 0, 0}, aside, 600);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->skin.norm(), kSmallSkin, 0.0005);
}

TEST(Crossings, AreThoseOfTheLastBoneAndNoneBehindOtherBone) {
  const auto along_z = [](const SmallHead& head) {
    return crossing_of(head.scan(), {0, 0, 0}, {0, 0, 1}, 600);
  };
  EXPECT_FALSE(along_z(SmallHead{}.with(ball({0, 0, 0.02}, 0.004, 1000)))) << "a calcified falx";
  SmallHead with_marrow;
  with_marrow.solids[2] = ball({0, 0, -0.007}, 0.03, 35);
  const auto crossing = along_z(with_marrow.with(ball({0, 0, 0.033}, 0.003, 150)));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->skull.z(), kSmallSkull, 0.0006);
}

TEST(Crossings, EndAtTheSkinUnderAMarkerThatAirSeparatesFromIt) {
  SmallHead marked;
  marked.with(ball({0, 0, kSmallSkin + 0.0035}, 0.0015, 2500));
  const auto crossing = crossing_of(marked.scan(), {0, 0, 0}, {0, 0, 1}, 600);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->skin.z(), kSmallSkin, 0.0006);
}

TEST(Crossings, AreNoneWhereTheScanEndsWithinTheHead) {
  VolumeGeometry cut{.size = {101, 101, 84}};  // its last slice is 33 mm above the middle
  cut.origin = Vector3d::Constant(-0.05);
  const Volume head = scanned(SmallHead{}.solids, cut, {.noise_hu = 10, .seed = 4});
  for (double up = 0; up < 1.5; up += 0.05) {
    const Vector3d direction{std::cos(up), 0, std::sin(up)};
    const auto crossing = crossing_of(head, {0, 0, 0}, direction, 600);
    if (kSmallSkin * direction.z() > 0.033) {
      EXPECT_FALSE(crossing) << up;
    } else if (up < 0.6) {
      ASSERT_TRUE(crossing) << up;
      EXPECT_NEAR(crossing->skin.norm(), kSmallSkin, 0.0005) << up;
    }
  }
}

TEST(Crossings, WithoutASkullAreNone) {
  EXPECT_FALSE(
      crossing_of(scanned({}, {.size = {20, 20, 20}}, {}), {0.01, 0.01, 0.01}, {0, 0, 1}, 600));
}

}  // namespace
}  // namespace armature::image::needle_planner
