// SPDX-License-Identifier: Apache-2.0
// The ways in: 1. limits, 2. order and reasons.
#include "ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "armature/values/angles.hpp"
#include "small_head_test.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

const Volume& head() {
  static const Volume volume = SmallHead{}.scan();
  return volume;
}

/// From above, all that a head of balls lets through.
Parameters from_above() { return {.approach = {0, 0, 1}, .cone = 60 * kRadPerDegree}; }

std::vector<Way> ways(const Vector3d& target, const std::vector<ForbiddenZone>& vessels = {},
                      const std::vector<ForbiddenZone>& markers = {},
                      const Parameters& parameters = from_above()) {
  const auto found = ways_to(target, head(), vessels, markers, parameters);
  if (!found) ADD_FAILURE() << found.error().text;
  return found.value_or(std::vector<Way>{});
}

std::string refusal(const Vector3d& target, const Parameters& parameters,
                    const std::vector<ForbiddenZone>& vessels = {}) {
  const auto found = ways_to(target, head(), vessels, {}, parameters);
  return found ? "found" : found.error().text;
}

TEST(Ways, AreCheapestFirstAndApart) {
  const Vector3d target{0.005, 0, 0.01};
  const auto found = ways(target);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_TRUE(std::ranges::is_sorted(found, {}, &Way::cost));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].entry.norm(), kSmallSkin, 0.0006);
    EXPECT_DOUBLE_EQ(found[i].cost,
                     found[i].vessel_cost + found[i].length_cost + found[i].angle_cost);
    for (std::size_t k = 0; k < i; ++k) {
      const Vector3d a = (found[i].entry - target).normalized();
      const Vector3d b = (found[k].entry - target).normalized();
      EXPECT_LT(a.dot(b), std::cos(4.99 * kRadPerDegree));
    }
  }
}

TEST(Ways, KeepAwayFromVesselsAsFarAsTheirLimitSays) {
  const ForbiddenZone above{"vessel 1", {-0.02, 0, 0.025}, {0.02, 0, 0.025}, 0.002};
  const auto found = ways({0, 0, 0}, {above});
  for (const Way& way : found) {
    EXPECT_GE(clearance({0, 0, 0}, way.entry, above), 0.004 - 1e-12);
    EXPECT_EQ(way.vessel, "vessel 1");
  }
  EXPECT_GT(std::abs(found.front().entry.y()), 0.01);
}

TEST(Ways, HeavierVesselsPushThemFartherAway) {
  const Vector3d target{0, 0.012, 0.012};  // its shortest way goes past the vessel
  const ForbiddenZone vessel{"vessel 1", {0.009, 0.024, 0.024}, {0.009, 0.026, 0.026}, 0.002};
  Parameters heavy = from_above();
  heavy.weights = {10, 1, 1};
  EXPECT_GT(ways(target, {vessel}, {}, heavy).front().vessel_distance,
            ways(target, {vessel}).front().vessel_distance + 0.001);
}

TEST(Ways, GoThroughNoMarkerNotEvenOutsideOfTheHead) {
  const ForbiddenZone marker{"marker", {0, 0, 0.09}, {0, 0, 0.09}, 0.008};
  for (const Way& way : ways({0, 0, 0}, {}, {marker})) {
    const Vector3d direction = way.entry.normalized();
    EXPECT_GT(clearance({0, 0, 0}, way.entry + 0.06 * direction, marker), 0);
  }
}

TEST(Ways, GoThroughNoBoneBeforeTheSkull) {
  const Vector3d falx{0, 0, 0.02};
  Parameters all = from_above();
  all.cone = 30 * kRadPerDegree;
  all.ways = 50;
  const auto found =
      ways_to({0, 0, 0}, SmallHead{}.with(ball(falx, 0.004, 1000)).scan(), {}, {}, all);
  ASSERT_TRUE(found) << found.error().text;
  for (const Way& way : *found) {
    EXPECT_GT(clearance({0, 0, 0}, way.entry, {"falx", falx, falx, 0.0035}), 0);
  }
}

TEST(Ways, StayInTheConeOfTheApproach) {
  Parameters aside = from_above();
  aside.approach = {0, 2, 0};
  aside.cone = 20 * kRadPerDegree;
  for (const Way& way : ways({0, 0, 0}, {}, {}, aside)) {
    EXPECT_GT(way.entry.normalized().y(), std::cos(20.01 * kRadPerDegree));
  }
}

TEST(Ways, ThatAreNoneSayWhatKeptThemOut) {
  Parameters near = from_above(), aslant = from_above();
  near.max_length = 0.02;
  EXPECT_THAT(refusal({0, 0, 0}, near),
              HasSubstr("no way in: of 1000 directions 0 meet no skull and "
                        "skin, 1000 are too long, 0 meet"));
  aslant.max_skull_angle = 1 * kRadPerDegree;
  aslant.cone = 20 * kRadPerDegree;
  EXPECT_THAT(refusal({0.03, 0, 0}, aslant), HasSubstr("meet the skull too aslant, 0 go"));
  const ForbiddenZone about{"vessel 1", {0, 0, 0}, {0, 0, 0}, 0.01};
  EXPECT_THAT(refusal({0, 0, 0}, from_above(), {about}),
              HasSubstr("0 go through a marker, 1000 come too near to a vessel"));
  EXPECT_THAT(refusal({0.3, 0, 0}, from_above()), HasSubstr("1000 meet no skull and skin"));
}

TEST(Ways, TellTheirReasonsInWords) {
  const Way way{.entry = {0, 0, 0},
                .length = 0.0712,
                .vessel_distance = 0.0091,
                .vessel = "vessel 2",
                .skull_angle = 4 * kRadPerDegree,
                .cost = 1.28,
                .vessel_cost = 0.44,
                .length_cost = 0.712,
                .angle_cost = 0.13};
  EXPECT_EQ(reason_of(way),
            "vessel 2 is 9.1 mm away (0.44), 71 mm long (0.71), 4 degrees off the skull's normal "
            "(0.13)");
  EXPECT_THAT(reason_of(Way{}), HasSubstr("no vessel, "));
}

}  // namespace
}  // namespace armature::image::needle_planner
