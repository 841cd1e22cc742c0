// SPDX-License-Identifier: Apache-2.0
// Where a tip rests: 1. the mean of its window, 2. why it does not.
#include "tip_rest.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;

class TipRestTest : public testing::Test {
 protected:
  void see(const Vector3d& tip) { rest_.see(tip, now_ = now_ + seconds(0.001)); }
  void see_for(double duration_s, const Vector3d& tip) {
    for (int i = 0; i < static_cast<int>(std::lround(duration_s * 1000)); ++i) see(tip);
  }
  std::string why() const {
    const auto place = rest_.place(now_);
    return place ? "" : place.error().text;
  }

  TipRest rest_{seconds(0.5), 0.0002};
  Time now_;
};

TEST_F(TipRestTest, IsAtTheMeanOfItsWindow) {
  see_for(1, {9, 9, 9});
  for (int i = 0; i <= 500; ++i) see({1 + (i % 2 == 0 ? 1e-4 : -1e-4), 2, 3});
  const auto place = rest_.place(now_);
  ASSERT_TRUE(place) << place.error().text;
  EXPECT_LT((*place - Vector3d{1, 2, 3}).norm(), 1e-6);
}

TEST_F(TipRestTest, OneThatMovesDoesNotRest) {
  for (int i = 0; i <= 500; ++i) see({1e-6 * i, 0, 0});
  EXPECT_TRUE(rest_.moves());
  EXPECT_EQ(why(),
            "the tip was up to 0.25 mm from its mean place within 0.5 s, 0.2 mm are allowed "
            "(max_touch_spread_mm): hold it still");
}

TEST_F(TipRestTest, OneThatWasSeenTooBrieflyOrIsNotSeenNowHasNoPlace) {
  EXPECT_EQ(why(), "the arm has not told yet where it is");
  see_for(0.4, {1, 2, 3});
  EXPECT_EQ(why(), "the tip has been seen for 0.40 s only, 0.5 s are required (touch_rest_s)");
  EXPECT_FALSE(rest_.moves());
  see_for(0.2, {1, 2, 3});
  EXPECT_EQ(why(), "");
  now_ = now_ + seconds(0.3);
  EXPECT_EQ(why(), "the arm has not told for 0.30 s where it is");
  see({1, 2, 3});
  EXPECT_EQ(why(), "the tip has been seen for 0.00 s only, 0.5 s are required (touch_rest_s)")
      << "what was between is not known";
}

TEST_F(TipRestTest, StampsThatStepBackBeginAnewAndOnesThatLieAheadAreSaid) {
  see_for(0.6, {1, 2, 3});
  rest_.see({1, 2, 3}, now_ + seconds(3600.0));
  EXPECT_EQ(why(), "the arm's stamps are 3600.00 s ahead of this clock");
  see_for(0.6, {1, 2, 3});
  EXPECT_EQ(why(), "");
}

}  // namespace
}  // namespace armature::task::biopsy
