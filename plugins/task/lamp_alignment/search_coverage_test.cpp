// SPDX-License-Identifier: Apache-2.0
// What the search sees: 1. single faces, by hand, 2. laws, 3. the shares of the shipped rigs, which
// whole runs agree with (tests/end_to_end/lamp_full_test.cpp).
#include "search_coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <numeric>
#include <random>

#include "armature/values/angles.hpp"
#include "armature/values/sanitizer.hpp"
#include "search_poses.hpp"

namespace armature::task::lamp_alignment {
namespace {

using testing::HasSubstr, testing::StartsWith;

const RobotModel& lamp() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  return model;
}

StereoRig rig(const std::string& name) {
  return load_stereo_rig(ARMATURE_SOURCE_DIR "/configs/rigs/" + name + ".yaml");
}

SearchCoverage coverage(const std::string& rig_name, const Parameters& parameters = {}) {
  return SearchCoverage::make(parameters, lamp(), rig(rig_name),
                              search_poses(parameters, lamp().joints().back().a))
      .value();
}

/// One view from (0, 0, 0.5) along x.
SearchCoverage level_view(const Parameters& parameters = {}) {
  const ToolPose view{.position = {0, 0, 0.5}, .orientation = Direction{Eigen::Vector3d::UnitX()}};
  return SearchCoverage::make(parameters, lamp(), rig("default"), {view}).value();
}

Parameters wide_search() {
  Parameters parameters;
  parameters.search_pitch = {40 * kRadPerDegree, 0, -40 * kRadPerDegree};
  return parameters;
}

Parameters paper_search() {
  Parameters parameters;
  parameters.eye_distance = 0.104;
  return parameters;
}

TEST(SearchCoverage, SeesAFaceThatLooksIntoTheLamp) {
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, 0, 0.5}}), Sight::seen);
}

TEST(SearchCoverage, ANearFaceBesideTheAxisIsNotWholeInBothPictures) {
  // At 0.7 m the pictures of 70 degrees end 0.49 m aside and 0.275 m up, less the cameras' 60 mm.
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, 0.34, 0.5}}), Sight::seen);
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, 0.38, 0.5}}), Sight::outside_pictures);
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, -0.38, 0.5}}), Sight::outside_pictures);
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, 0, 0.66}}), Sight::seen);
  EXPECT_EQ(level_view().sight_of({.mouth = {0.7, 0, 0.70}}), Sight::outside_pictures);
  EXPECT_EQ(level_view().sight_of({.mouth = {-0.7, 0, 0.5}}), Sight::outside_pictures);
}

TEST(SearchCoverage, AFaceMayLookPastTheLampByTheDetectorsAngle) {
  // Each camera is 60 mm aside of the axis, 3.4 degrees at a metre.
  for (const double sign : {-1, 1}) {
    const auto turned = [&](double degrees) {
      return level_view().sight_of(
          {.mouth = {1, 0, 0.5}, .tilt_side = sign * degrees * kRadPerDegree});
    };
    EXPECT_EQ(turned(31), Sight::seen);
    EXPECT_EQ(turned(33), Sight::turned_away);
    EXPECT_EQ(turned(170), Sight::turned_away);
    EXPECT_EQ(level_view().sight_of({.mouth = {1, 0, 0.5}, .tilt_up = sign * 32 * kRadPerDegree}),
              Sight::seen);
    EXPECT_EQ(level_view().sight_of({.mouth = {1, 0, 0.5}, .tilt_up = sign * 38 * kRadPerDegree}),
              Sight::turned_away);
  }
}

TEST(SearchCoverage, AFaceMayBeAsFarAsItIsLargeEnough) {
  Parameters parameters;
  EXPECT_EQ(level_view(parameters).sight_of({.mouth = {1.6, 0, 0.5}}), Sight::seen);
  EXPECT_EQ(level_view(parameters).sight_of({.mouth = {1.7, 0, 0.5}}), Sight::at_wrong_depth);
  parameters.min_face = 40;
  EXPECT_EQ(level_view(parameters).sight_of({.mouth = {1.7, 0, 0.5}}), Sight::seen);
  EXPECT_EQ(level_view(parameters).sight_of({.mouth = {2.1, 0, 0.5}}), Sight::at_wrong_depth);
}

TEST(SearchCoverage, OfEveryRigIsThatOfTheRunsOfWholeLamps) {
  const auto sight = [](const SearchCoverage& search, const Eigen::Vector3d& mouth, double up_deg,
                        double side_deg) {
    return search.sight_of(
        {.mouth = mouth, .tilt_up = up_deg * kRadPerDegree, .tilt_side = side_deg * kRadPerDegree});
  };
  const SearchCoverage narrow = coverage("default"), paper = coverage("paper", paper_search()),
                       wide = coverage("wide", wide_search());
  EXPECT_EQ(sight(narrow, {1.45, -0.1, 0.9}, -25, 20), Sight::seen);
  EXPECT_EQ(sight(narrow, {1.25, 0, 0.98}, 0, 0), Sight::outside_pictures);
  EXPECT_EQ(sight(paper, {1.5, 0.1, 0.5}, 5, -20), Sight::seen);
  EXPECT_EQ(sight(paper, {1.25, 0.18, 0.27}, -15, 0), Sight::outside_pictures);
  EXPECT_EQ(sight(wide, {1.25, -0.25, 0.25}, 20, 25), Sight::seen);
  EXPECT_EQ(sight(wide, {1.4, 0.25, 0.75}, 30, 30), Sight::turned_away);
}

TEST(SearchCoverage, OfTheWideCamerasHasHighAndLowFacesThatThoseOfTheDefaultRigHaveNotWhole) {
  const SearchCoverage wide = coverage("wide", wide_search()), narrow = coverage("default");
  for (const Face& face : {Face{.mouth = {1.35, 0, 1.0}, .tilt_up = -40 * kRadPerDegree},
                           Face{.mouth = {1.2, 0, 0}, .tilt_up = 35 * kRadPerDegree},
                           Face{.mouth = {1.2, -0.3, 0.1}, .tilt_up = 40 * kRadPerDegree}}) {
    EXPECT_EQ(wide.sight_of(face), Sight::seen) << face.mouth.transpose();
    EXPECT_NE(narrow.sight_of(face), Sight::seen) << face.mouth.transpose();
  }
  const Face high_aside{.mouth = {1.3, 0.3, 0.9}, .tilt_up = -40 * kRadPerDegree};
  EXPECT_EQ(wide.sight_of(high_aside), Sight::seen);
  EXPECT_EQ(narrow.sight_of(high_aside), Sight::seen);
}

TEST(SearchCoverage, MoreViewsAWiderAngleAndSmallerFacesNeverSeeLess) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> one{-1, 1};
  Parameters more;
  more.search_yaw.push_back(60 * kRadPerDegree);
  Parameters wider;
  wider.max_face_angle = 45 * kRadPerDegree;
  Parameters smaller;
  smaller.min_face = 40;
  const SearchCoverage plain = coverage("default");
  const std::vector<SearchCoverage> better{coverage("default", more), coverage("default", wider),
                                           coverage("default", smaller)};
  for (int i = 0; i < 3000; ++i) {
    const Face face{.mouth = {1.6 + 0.7 * one(random), 0.6 * one(random), 0.5 + one(random)},
                    .tilt_up = one(random),
                    .tilt_side = one(random)};
    const Sight before = plain.sight_of(face);
    for (const SearchCoverage& now : better) EXPECT_GE(now.sight_of(face), before);
  }
}

TEST(SearchCoverage, SharesAreOfAllFacesAndNameWhereFewAreSeen) {
  const SearchCoverage::Shares shares = coverage("default").shares();
  EXPECT_NEAR(std::accumulate(shares.of_sight.begin(), shares.of_sight.end(), 0.0), 1, 1e-12);
  ASSERT_FALSE(shares.blind.empty());
  for (const auto& [name, seen] : shares.blind) EXPECT_LT(seen, 0.5) << name;
  const auto names = [&](const std::string& name) {
    return std::ranges::find(shares.blind, name, &SearchCoverage::Shares::Region::name) !=
           shares.blind.end();
  };
  EXPECT_TRUE(names("high and turned up"));
  EXPECT_TRUE(names("low and turned down"));
  EXPECT_FALSE(names("at middle height and straight"));
}

TEST(SearchCoverage, ARigOnAnotherLinkThanTheToolIsNotJudged) {
  StereoRig elsewhere = rig("default");
  elsewhere.mounted_on = "elbow";
  EXPECT_FALSE(SearchCoverage::make({}, lamp(), elsewhere, search_poses({}, 0.08)));
}

struct ShippedRig {
  std::string rig;
  Parameters parameters;
  double seen;

  friend void PrintTo(const ShippedRig& shipped, std::ostream* out) { *out << shipped.rig; }
};

class SearchCoverageOfRig : public testing::TestWithParam<ShippedRig> {};

TEST_P(SearchCoverageOfRig, IsAsStatedAndCostsNoMoreThanAFifthOfASecond) {
  const auto& [name, parameters, seen] = GetParam();
  const SearchCoverage search = coverage(name, parameters);
  const std::clock_t before = std::clock();
  const auto lines = search.lines();
  const double took_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  if (!kSanitized) {
    EXPECT_LT(took_s, 0.2);
  }
  EXPECT_NEAR(search.shares().of_sight.back(), seen, 0.005);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], StartsWith("the search sees "));
  EXPECT_THAT(lines[0], HasSubstr("mouths at x 1.2..1.6 m, y -0.3..0.3 m, z 0.2..0.8 m, turned up, "
                                  "down and aside by up to 30 degrees"));
  EXPECT_THAT(lines[1], HasSubstr("turned away from every view by more than 35 degrees"));
}

INSTANTIATE_TEST_SUITE_P(Shipped, SearchCoverageOfRig,
                         testing::Values(ShippedRig{"default", {}, 0.482},
                                         ShippedRig{"paper", paper_search(), 0.490},
                                         ShippedRig{"wide", wide_search(), 0.609}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature::task::lamp_alignment
