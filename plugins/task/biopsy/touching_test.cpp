// SPDX-License-Identifier: Apache-2.0
// Which places of a tip are taken for markers, and which are not.
#include "touching.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;

class TouchingTest : public testing::Test {
 protected:
  TouchingTest() { touching_.begin({{0, 0, 0}, {0.06, 0, 0}, {0, 0.1, 0}}); }
  void rest_at(const Vector3d& tip) {
    for (int i = 0; i <= 600; ++i) touching_.see_tip(tip, now_ = now_ + seconds(0.001));
  }
  void move_to(const Vector3d& tip) {
    touching_.see_tip(tip + Vector3d{0.01, 0, 0}, now_ = now_ + seconds(0.001));
    for (int i = 0; i < 300; ++i) touching_.see_tip(tip, now_ = now_ + seconds(0.001));
    EXPECT_FALSE(touching_.rests_anew(now_));
    rest_at(tip);
  }
  std::string take() {
    const auto taken = touching_.take(now_);
    return taken ? "" : taken.error().text;
  }

  Touching touching_{{}};
  Time now_;
};

TEST_F(TouchingTest, TakesOnePlaceAfterTheOtherAndDropsTheLast) {
  std::size_t version = touching_.version();
  for (const Vector3d& place : {Vector3d{1, 1, 1}, Vector3d{1, 1.1, 1}, Vector3d{1.06, 1, 1}}) {
    rest_at(place);
    EXPECT_EQ(take(), "");
    EXPECT_LT((touching_.places().back() - place).norm(), 1e-12);
    EXPECT_NE(std::exchange(version, touching_.version()), touching_.version());
  }
  EXPECT_EQ(touching_.places().size(), touching_.count());
  touching_.drop_last();
  EXPECT_EQ(touching_.places().size(), 2u);
  EXPECT_NE(version, touching_.version());
}

TEST_F(TouchingTest, TheSameMarkerTwiceIsNamed) {
  rest_at({1, 1, 1});
  take();
  rest_at({1.0005, 1, 1});
  EXPECT_EQ(take(), "this is touch 1 again, 0.5 mm beside it: go on to another marker");
  EXPECT_EQ(touching_.places().size(), 1u);
}

TEST_F(TouchingTest, APlaceThatIsAsFarAwayAsNoMarkerIsNamed) {
  rest_at({1, 1, 1});
  take();
  rest_at({1, 1.085, 1});
  EXPECT_EQ(
      take(),
      "this place is 85.0 mm from touch 1, and no two markers of the plan are: 100.0 mm comes "
      "nearest. Touch a marker, or say back and touch that one again");
}

TEST_F(TouchingTest, RestsAnewOnlyAfterItHasMoved) {
  rest_at({1, 1, 1});
  EXPECT_FALSE(touching_.rests_anew(now_)) << "where it began is no touch";
  move_to({1, 1.5, 1});
  EXPECT_TRUE(touching_.rests_anew(now_));
  EXPECT_EQ(take(), "");
  rest_at({1, 1.5, 1});
  EXPECT_FALSE(touching_.rests_anew(now_)) << "it was taken";
}

TEST_F(TouchingTest, IsClearWhereItRestsOutsideOfTheBallAboutAllPlaces) {
  rest_at({1, 1, 1});
  take();
  rest_at({1, 1.1, 1});
  take();
  rest_at({1, 1.05, 1.04});  // between both, 64 mm from each
  const auto near = touching_.is_clear(now_);
  ASSERT_FALSE(near);
  EXPECT_EQ(
      near.error().text,
      "the tip is 40 mm from the middle of the touched places, 80 mm are required, 30 mm more "
      "than the farthest of them (min_touch_clearance_mm): lead it away from the head");
  touching_.see_tip({1, 1.05, 1.2}, now_ = now_ + seconds(0.001));
  EXPECT_FALSE(touching_.is_clear(now_)) << "it moves";
  rest_at({1, 1.05, 1.2});
  EXPECT_TRUE(touching_.is_clear(now_));
}

TEST_F(TouchingTest, WhatWasSeenBeforeAHandHadTheArmIsNoRest) {
  move_to({1, 1.5, 1});
  rest_at({1, 1.5, 1});
  touching_.begin_rest();
  EXPECT_FALSE(touching_.rests_anew(now_));
  EXPECT_NE(take().find("the arm has not told yet where it is"), std::string::npos);
}

}  // namespace
}  // namespace armature::task::biopsy
