// SPDX-License-Identifier: Apache-2.0
#include "pair_matcher.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

namespace armature::camera::stereo_pair {
namespace {

Time at_ms(double ms) { return Time{} + seconds(1e-3 * ms); }

class PairMatcherTest : public testing::Test {
 protected:
  void left(double ms) { matcher_.add(Side::left, {at_ms(ms), {}}); }
  void right(double ms) { matcher_.add(Side::right, {at_ms(ms), {}}); }
  /// "10+12 30+30": the stamps of all pairs that are complete.
  std::string pairs() {
    std::string text;
    while (const auto pair = matcher_.next()) {
      text += (text.empty() ? "" : " ") + ms(pair->left.stamp) + "+" + ms(pair->right.stamp);
    }
    return text;
  }
  static std::string ms(Time stamp) { return std::to_string((stamp - Time{}).count() / 1'000'000); }

  PairMatcher matcher_{seconds(0.005)};
};

class WideSkewTest : public PairMatcherTest {
 protected:
  WideSkewTest() { matcher_ = PairMatcher{seconds(0.05)}; }
};

TEST_F(PairMatcherTest, PairsPicturesThatAreAtMostTheSkewApart) {
  left(10);
  EXPECT_EQ(pairs(), "");
  right(15);
  EXPECT_EQ(pairs(), "10+15");
  right(40);
  left(34);
  EXPECT_EQ(pairs(), "");
  EXPECT_EQ(matcher_.unpaired(), 1U) << "34 ms: no right picture can come for it any more";
  EXPECT_EQ(matcher_.last_distance(), seconds(0.006));
  left(42);
  EXPECT_EQ(pairs(), "42+40");
  EXPECT_EQ(matcher_.unpaired(), 1U);
}

TEST_F(PairMatcherTest, APairHasTheStampInTheMiddle) {
  left(10);
  right(14);
  const auto pair = matcher_.next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->stamp(), at_ms(12));
  EXPECT_EQ(pair->skew(), seconds(0.004));
}

TEST_F(PairMatcherTest, TakesTheNearestOfSeveral) {
  right(6);
  right(9);
  left(10);
  EXPECT_EQ(pairs(), "10+9");
  EXPECT_EQ(matcher_.unpaired(), 1U);
}

TEST_F(PairMatcherTest, APictureThatIsLostCostsItsPairOnly) {
  for (const double ms : {0, 33, 66, 99}) left(ms);
  for (const double ms : {1, 67, 100}) right(ms);
  EXPECT_EQ(pairs(), "0+1 66+67 99+100");
  EXPECT_EQ(matcher_.unpaired(), 1U);
  EXPECT_EQ(matcher_.last_distance(), seconds(0.032)) << "to the picture at 1 ms";
}

TEST_F(PairMatcherTest, ACameraWhoseClockGoesBackBeginsAnew) {
  left(1000);
  left(1033);
  left(10);
  right(11);
  EXPECT_EQ(pairs(), "10+11");
  EXPECT_EQ(matcher_.unpaired(), 2U);
}

TEST_F(PairMatcherTest, HoldsNoMoreThanItsRoomOfACameraWhoseTwinIsSilent) {
  for (int i = 0; i < 100; ++i) left(i);
  EXPECT_EQ(matcher_.unpaired(), 100 - PairMatcher::kMaxWaiting);
  EXPECT_EQ(matcher_.last_distance(), std::nullopt);
  right(99);
  EXPECT_EQ(pairs(), "99+99");
}

/// Of 30 Hz each, the right one 30 ms behind the left one, which is 3 ms before its next picture.
TEST_F(WideSkewTest, ThePictureThatIsNearestMayComeLater) {
  std::string all;
  for (int i = 0; i < 5; ++i) {
    left(33 * i);
    all += pairs() + ";";
    right(33 * i + 30);
    all += pairs() + ";";
  }
  EXPECT_EQ(all, ";0+30;;;66+63;;99+96;;132+129;;")
      << "how fast a camera is, its second picture tells";
}

TEST_F(WideSkewTest, APictureWaitsForANearerOneNoLongerThanUntilTheNextOfItsOwnCamera) {
  left(0);
  left(33);
  right(1);
  EXPECT_EQ(pairs(), "0+1");
  right(63);
  EXPECT_EQ(pairs(), "") << "66 would be nearer, and is lost";
  right(96);
  EXPECT_EQ(pairs(), "33+63");
  left(99);
  EXPECT_EQ(pairs(), "99+96");
  EXPECT_EQ(matcher_.unpaired(), 0U);
}

TEST_F(WideSkewTest, PairsThatAreNearerThanHalfAPeriodWaitForNothing) {
  for (int i = 0; i < 5; ++i) {
    left(33 * i);
    right(33 * i + 16);
    EXPECT_EQ(pairs(), ms(at_ms(33 * i)) + "+" + ms(at_ms(33 * i + 16)));
  }
}

/// Two free running cameras of 30 Hz at any distance, each with 1 ms of jitter.
TEST_F(WideSkewTest, NoPairIsFartherApartThanHalfAPeriodWhateverTheClocksAre) {
  constexpr std::uint64_t kSeed = 12;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> jitter{-1, 1};
  int paired = 0;
  for (int i = 0; i < 3000; ++i) {
    const double behind = 0.011 * i;  // of the right camera against the left one: up to a period
    left(33.3 * i + jitter(random));
    while (const auto pair = matcher_.next()) {
      EXPECT_LE(pair->skew(), seconds(0.0187)) << i;
      ++paired;
    }
    right(33.3 * i + behind + jitter(random));
    while (const auto pair = matcher_.next()) {
      EXPECT_LE(pair->skew(), seconds(0.0187)) << i;
      ++paired;
    }
  }
  EXPECT_GT(paired, 2950) << "near half a period the jitter decides which one is left over";
}

/// Two free running cameras of 30 Hz, each with 1 ms of jitter, and every tenth picture lost.
TEST_F(PairMatcherTest, NeverPairsWhatIsTooFarApartAndLosesNoPictureUncounted) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> jitter{-1, 1}, lost{0, 1}, order{0, 1};
  std::size_t sent = 0, paired = 0, both = 0;
  for (int i = 0; i < 3000; ++i) {
    const double drift = 0.002 * i;  // of the right camera against the left one: up to 6 ms
    const bool has_left = lost(random) > 0.1, has_right = lost(random) > 0.1;
    const double l = 33.3 * i + jitter(random), r = 33.3 * i + drift + jitter(random);
    const bool left_first = order(random) < 0.5;
    if (has_left && left_first) left(l);
    if (has_right) right(r);
    if (has_left && !left_first) left(l);
    sent += has_left + has_right;
    both += has_left && has_right && std::abs(l - r) <= 5;
    while (const auto pair = matcher_.next()) {
      EXPECT_LE(pair->skew(), seconds(0.005));
      ++paired;
    }
  }
  EXPECT_EQ(paired, both);
  EXPECT_LE(sent - 2 * paired - matcher_.unpaired(), 2 * PairMatcher::kMaxWaiting);
}

}  // namespace
}  // namespace armature::camera::stereo_pair
