// SPDX-License-Identifier: Apache-2.0
// Whether a body is still seen: 1. by the light of its last sample, 2. by one that is not the last
// one again, 3. by a tracker that is not frozen.
#include "sighting.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature::task::implant {
namespace {

constexpr Time after(double s) { return Time{} + seconds(s); }

Sighting seen_at(double s) {
  return {.stamp = after(s), .tracker_T_body = Eigen::Isometry3d::Identity()};
}

TEST(BodyWatch, SaysForHowLongWhichBodyWasNotSeenAndWhy) {
  BodyWatch watch{"the jaw", seconds(0.5)};
  watch.begin(after(10));
  EXPECT_FALSE(watch.blind(after(10.5)));
  EXPECT_EQ(watch.blind(after(10.6)),
            "the tracker has not seen the jaw for 0.60 s: it sends nothing");
  watch.see({.stamp = after(10.6), .tracker_T_body = {}, .reason = "its spheres are hidden"});
  EXPECT_EQ(watch.blind(after(10.7)),
            "the tracker has not seen the jaw for 0.70 s: its spheres are hidden");
}

TEST(BodyWatch, CountsFromTheLightOfTheLastSample) {
  BodyWatch watch{"the flange", seconds(0.5)};
  watch.begin(after(10));
  watch.see(seen_at(11));
  EXPECT_FALSE(watch.blind(after(11.5)));
  EXPECT_EQ(watch.blind(after(11.52)),
            "the tracker has not seen the flange for 0.52 s: it sends nothing");
  watch.see(seen_at(9));
  EXPECT_TRUE(watch.blind(after(11.52))) << "an old sample changes nothing";
}

/// A body whose tracker errs by 0.1 mm, unless it is frozen.
class NoisyBody {
 public:
  Sighting at(double s) {
    std::normal_distribution<double> error{0, 1e-4};
    const Eigen::Vector3d shift{error(random_), error(random_), error(random_)};
    if (!frozen) last_ = Eigen::Translation3d{Eigen::Vector3d{0.1, 0.2, 1.5} + shift};
    return {.stamp = after(s), .tracker_T_body = last_};
  }
  bool frozen = false;

 private:
  std::mt19937_64 random_{3};  // a fixed seed
  Eigen::Isometry3d last_ = Eigen::Isometry3d::Identity();
};

TEST(BodyWatch, ASampleThatComesTwiceCountsOnce) {
  BodyWatch watch{"the jaw", seconds(0.5)};
  NoisyBody body;
  const Sighting first = body.at(1);
  EXPECT_TRUE(watch.see(first));
  EXPECT_FALSE(watch.see(first));
  EXPECT_TRUE(watch.see(body.at(1.02)));
  EXPECT_FALSE(watch.see(first)) << "an older one once more";
}

TEST(BodyWatch, ATrackerThatErrsAndThenGivesOnePoseAgainAndAgainIsFrozen) {
  BodyWatch watch{"the jaw", seconds(0.5)};
  NoisyBody body;
  watch.begin(after(0));
  double s = 0;
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(watch.see(body.at(s += 0.02)));
  body.frozen = true;
  for (int i = 0; i < 24; ++i) {
    EXPECT_FALSE(watch.see(body.at(s += 0.02)));
    EXPECT_FALSE(watch.blind(after(s)));
  }
  EXPECT_FALSE(watch.see(body.at(s += 0.04)));
  EXPECT_EQ(watch.blind(after(s)),
            "the tracker has not seen the jaw for 0.52 s: it gives the same pose again and again");
  body.frozen = false;
  EXPECT_TRUE(watch.see(body.at(s)));
  EXPECT_FALSE(watch.blind(after(s)));
}

TEST(BodyWatch, ATrackerThatNeverErrsIsNotFrozen) {
  BodyWatch watch{"the jaw", seconds(0.5)};
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 200; ++i) {
    if (i % 50 == 0) place.translation().x() += 0.01;  // it is put elsewhere, and rests there
    EXPECT_TRUE(watch.see({.stamp = after(0.02 * i), .tracker_T_body = place}));
  }
  EXPECT_FALSE(watch.blind(after(4)));
}

TEST(BodyWatch, ABodyThatIsCarriedOnAndKeepsItsPoseIsFrozen) {
  BodyWatch watch{"the flange", seconds(0.5)};
  EXPECT_TRUE(watch.see(seen_at(1), false));
  EXPECT_TRUE(watch.see(seen_at(1.02), true));
  EXPECT_FALSE(watch.see(seen_at(1.04), false));
}

TEST(BodyWatch, ALightThatIsStampedAheadOfTheClockIsNone) {
  BodyWatch watch{"the jaw", seconds(0.5)};
  watch.begin(after(10));
  watch.see(seen_at(10.5));
  EXPECT_FALSE(watch.blind(after(10)));
  watch.see(seen_at(70));
  EXPECT_EQ(watch.blind(after(10)), "the tracker stamps the jaw 60.00 s ahead of this clock");
}

TEST(BodyWatch, BeginsAnew) {
  BodyWatch watch{"the flange", seconds(0.5)};
  watch.begin(after(0));
  EXPECT_TRUE(watch.blind(after(1)));
  watch.begin(after(1));
  EXPECT_FALSE(watch.blind(after(1)));
}

}  // namespace
}  // namespace armature::task::implant
