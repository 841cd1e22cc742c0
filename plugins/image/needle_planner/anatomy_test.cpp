// SPDX-License-Identifier: Apache-2.0
// Lesion and vessels are found where they are, and what is not sure is not guessed.
#include "anatomy.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "small_head_test.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

TEST(Lesions, AreFoundToATenthOfAVoxelBesideAVessel) {
  const Vector3d centre{0.0053, -0.0041, 0.0067};
  for (const double noise : {0.0, 20.0}) {
    SmallHead head{.noise = noise};
    head.with(vessel_along({-0.01, 0.01, 0.02}, {0.015, 0.012, 0.022})).with(lesion_at(centre));
    const auto lesion = find_lesion(head.scan(), {});
    ASSERT_TRUE(lesion) << lesion.error().text;
    EXPECT_LT((lesion->centre - centre).cwiseAbs().maxCoeff(), 0.0001) << noise;
    EXPECT_NEAR(lesion->volume / (4.0 / 3 * std::numbers::pi * 216e-9), 1, 0.1) << noise;
  }
}

TEST(Lesions, ThatAreNotThereOrSeveralAreRefused) {
  EXPECT_EQ(find_lesion(SmallHead{}.scan(), {}).error().text,
            "no lesion was found: nothing of 5 mm or more has 68 to 180 Hounsfield units");
  SmallHead two;
  two.with(lesion_at({-0.015, 0, 0})).with(lesion_at({0.012, 0.003, 0.010}));
  EXPECT_EQ(find_lesion(two.scan(), {}).error().text,
            "2 lesions were found, at (-15, -0, 0) mm and (12, 3, 10) mm: which one is meant "
            "(lesion_near_mm)?");
  const auto chosen = find_lesion(two.scan(), {.lesion_near = {0.01, 0, 0.01}});
  ASSERT_TRUE(chosen);
  EXPECT_LT((chosen->centre - Vector3d{0.012, 0.003, 0.010}).norm(), 0.0002);
}

TEST(Lesions, FarFromWhereOneIsMeantAreNotTaken) {
  SmallHead two;
  two.with(lesion_at({-0.015, 0, 0})).with(lesion_at({0.012, 0.003, 0.010}));
  const Volume scan = two.scan();
  EXPECT_TRUE(find_lesion(scan, {.lesion_near = {-0.029, 0, 0}}));
  EXPECT_EQ(find_lesion(scan, {.lesion_near = {-0.015, 0, -0.020}}).error().text,
            "no lesion was found at lesion_near_mm: the nearest one, at (-15, -0, 0) mm, is 20 mm "
            "away; the one that is meant may touch a vessel or bone");
}

TEST(Lesions, AVesselAloneIsNone) {
  SmallHead head;
  head.with(vessel_along({-0.01, 0.01, 0.02}, {0.015, 0.012, 0.022}, 0.004));
  EXPECT_FALSE(find_lesion(head.scan(), {}));
}

TEST(Vessels, AreCapsulesWhereTheyAre) {
  SmallHead head;
  head.with(lesion_at({0, -0.01, 0}))
      .with(vessel_along({-0.010, 0.012, 0.015}, {0.014, 0.008, 0.018}, 0.0025))
      .with(vessel_along({0.02, -0.01, -0.01}, {0.01, -0.02, -0.015}, 0.004));
  const auto vessels = find_vessels(head.scan(), {});
  ASSERT_EQ(vessels.size(), 2u);
  EXPECT_EQ(vessels[1].name, "vessel 2");
  const ForbiddenZone& first = vessels[1];  // the second in the order of slices
  EXPECT_NEAR(first.radius_m, 0.0025, 0.0006);
  const Vector3d from{-0.010, 0.012, 0.015}, to{0.014, 0.008, 0.018};
  EXPECT_LT(std::min((first.from - from).norm(), (first.from - to).norm()), 0.001);
  EXPECT_LT(std::min((first.to - from).norm(), (first.to - to).norm()), 0.001);
  EXPECT_NEAR(vessels[0].radius_m, 0.004, 0.0006);
}

TEST(Vessels, OfASmallHeadWithoutContrastAreNone) {
  EXPECT_TRUE(find_vessels(SmallHead{}.scan(), {}).empty());
}

}  // namespace
}  // namespace armature::image::needle_planner
