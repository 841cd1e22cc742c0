// SPDX-License-Identifier: Apache-2.0
// Where a hand leads the tip: from marker to marker, and what makes it leave one.
#include "leading_hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace armature::sim::leading_hand {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d> kMarkers{{0.4, 0, 0.2}, {0.5, 0, 0.25}, {0.45, 0.1, 0.2}};
const Vector3d kHome{0.4, 0.3, 0.3};

class LeadingHandTest : public testing::Test {
 protected:
  LeadingHandTest() { begin({.touch_error = 0, .tremor = 0, .speed = 0.5, .rest = 1}); }
  void begin(const Parameters& parameters) {
    hand_.emplace(parameters, 4);
    hand_->take_hold(kMarkers, kHome, now_);
  }
  Vector3d step(bool halted = false) {
    now_ = now_ + seconds(0.001);
    return tip_ = hand_->lead(touches_, halted, now_);
  }
  void run(double duration_s) {
    for (double t = 0; t < duration_s && hand_->holds(); t += 0.001) step();
  }
  /// Until it rests on a marker; which one, or -1.
  int next_marker() {
    run(3.5);  // there, or waiting there
    for (std::size_t i = 0; i < kMarkers.size(); ++i) {
      if ((tip_ - kMarkers[i]).norm() < 1e-9) return static_cast<int>(i);
    }
    return -1;
  }

  Touches touches_{.wanted = true, .taken = 0, .by_itself = false};
  Time now_;
  Vector3d tip_ = kHome;
  std::optional<LeadingHand> hand_;
};

TEST_F(LeadingHandTest, TouchesEveryMarkerOnceAndGoesBack) {
  std::vector<int> touched;
  for (std::size_t i = 0; i < 3; ++i) {
    touched.push_back(next_marker());
    EXPECT_EQ(next_marker(), touched.back()) << "it waits until it is taken";
    ++touches_.taken;
  }
  std::ranges::sort(touched);
  EXPECT_EQ(touched, (std::vector<int>{0, 1, 2}));
  touches_.wanted = false;
  run(5);
  EXPECT_FALSE(hand_->holds());
  EXPECT_LT((tip_ - kHome).norm(), 1e-9);
}

TEST_F(LeadingHandTest, WhereNobodyConfirmsItLeavesAfterItsRest) {
  touches_.by_itself = true;
  run(60);
  EXPECT_FALSE(hand_->holds()) << "three markers, none of which was taken";
  EXPECT_LT((tip_ - kHome).norm(), 1e-9);
}

TEST_F(LeadingHandTest, GoesBackToAMarkerWhoseTouchWasDropped) {
  begin({.touch_error = 0, .tremor = 0, .speed = 0.5, .order = {2, 1, 3}});
  EXPECT_EQ(next_marker(), 1);
  ++touches_.taken;
  EXPECT_EQ(next_marker(), 0);
  --touches_.taken;
  EXPECT_EQ(next_marker(), 1);
}

TEST_F(LeadingHandTest, HaltedItComesToRestAndLetsGo) {
  run(0.5);
  const Vector3d before = tip_;
  for (int i = 0; i < 299; ++i) step(true);
  EXPECT_TRUE(hand_->holds());
  EXPECT_GT((tip_ - before).norm(), 1e-3);
  for (int i = 0; i < 3; ++i) step(true);
  EXPECT_FALSE(hand_->holds());
}

TEST_F(LeadingHandTest, MissesByItsErrorAndTrembles) {
  constexpr double kError = 0.002, kTremor = 0.0003;
  double squares = 0;
  constexpr int kHands = 400;
  for (int seed = 0; seed < kHands; ++seed) {
    LeadingHand hand{{.touch_error = kError, .tremor = 0, .speed = 1, .order = {1}},
                     static_cast<std::uint64_t>(seed)};
    hand.take_hold(kMarkers, kHome, Time{});
    hand.lead(touches_, false, Time{} + seconds(0.1));
    const Vector3d there = hand.lead(touches_, false, Time{} + seconds(9.0));
    squares += (there - kMarkers[0]).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / kHands), kError, 0.1 * kError);
  begin({.touch_error = 0, .tremor = kTremor, .speed = 0.5, .order = {1}});
  run(3.5);
  squares = 0;
  for (int i = 0; i < 5000; ++i) squares += (step() - kMarkers[0]).squaredNorm();
  EXPECT_NEAR(std::sqrt(squares / 5000), kTremor, 0.05 * kTremor);
}

}  // namespace
}  // namespace armature::sim::leading_hand
