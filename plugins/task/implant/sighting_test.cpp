// SPDX-License-Identifier: Apache-2.0
// Whether a body is still seen.
#include "sighting.hpp"

#include <gtest/gtest.h>

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

TEST(BodyWatch, BeginsAnew) {
  BodyWatch watch{"the flange", seconds(0.5)};
  watch.begin(after(0));
  EXPECT_TRUE(watch.blind(after(1)));
  watch.begin(after(1));
  EXPECT_FALSE(watch.blind(after(1)));
}

}  // namespace
}  // namespace armature::task::implant
