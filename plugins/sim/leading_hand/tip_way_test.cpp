// SPDX-License-Identifier: Apache-2.0
// The way of a tip that is led from place to place.
#include "tip_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace armature::sim::leading_hand {
namespace {

using Eigen::Vector3d;

const Vector3d kFrom{0.4, 0, 0.2}, kTo{0.5, -0.1, 0.3};

TEST(TipWay, GoesUpOverAndDownNoFasterThanItsSpeed) {
  const TipWay way{kFrom, kTo, 0.05, 0.1};
  EXPECT_EQ(way.at(0), kFrom);
  EXPECT_EQ(way.at(way.duration_s() + 1), kTo);
  constexpr double kStep_s = 1e-3;
  double fastest = 0, highest = 0;
  for (double t = 0; t < way.duration_s(); t += kStep_s) {
    const Vector3d here = way.at(t);
    fastest = std::max(fastest, (way.at(t + kStep_s) - here).norm() / kStep_s);
    highest = std::max(highest, here.z());
    const bool over_an_end =
        (here - kFrom).head<2>().norm() < 1e-12 || (here - kTo).head<2>().norm() < 1e-12;
    EXPECT_TRUE(over_an_end || here.z() > 0.35 - 1e-12) << "low, and beside both: " << t;
  }
  EXPECT_NEAR(highest, 0.35, 1e-12);
  EXPECT_LE(fastest, 0.1 + 1e-9);
  EXPECT_GT(fastest, 0.0999);
}

}  // namespace
}  // namespace armature::sim::leading_hand
