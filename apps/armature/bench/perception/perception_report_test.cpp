// SPDX-License-Identifier: Apache-2.0
// The report of `armature bench perception` counts what was found, refused and wrong, spreads the
// errors of valid poses only, and states times as parts of a full pass.
#include "bench/perception/perception_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

using testing::HasSubstr;

/// A pair with a valid pose.
PairResult valid_pair(const char* group, double mouth_m, double normal_rad = 0.01) {
  PairResult result{.group = group, .detected = true};
  result.pose = FacePose{};
  result.drawn = {mouth_m, normal_rad};
  result.stereo_only = PoseError{mouth_m / 2, normal_rad / 2};
  result.times = {.full_pass = 0.1, .detector = 0.12, .landmarks = 0.05, .estimator = 0.02};
  return result;
}

std::vector<PairResult> some_results() {
  PairResult refused{.group = "mask", .detected = true, .reason = "rows differ, by 7"};
  refused.times = {.full_pass = 0.1, .detector = 0.12, .landmarks = 0.05, .estimator = 0.04};
  PairResult unseen{.group = "mask", .reason = "no face in the left image"};
  unseen.times = {.full_pass = 0.3, .detector = 0.3};
  PairResult tracked = valid_pair("tracked", 0.003);
  tracked.is_tracked = true;
  tracked.times = {.detector = 0.02, .landmarks = 0.05, .estimator = 0.01};
  return {valid_pair("frontal", 0.001),
          valid_pair("frontal", 0.002),
          valid_pair("frontal", 0.009),
          refused,
          unseen,
          valid_pair("mask", 0.001, 0.2),
          tracked};
}

TEST(PerceptionReport, CountsFoundRefusedAndWrongButValid) {
  const auto rows = rows_of(some_results());
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].group, "frontal");
  EXPECT_EQ(rows[0].pairs, 3);
  EXPECT_EQ(rows[0].wrong, 1);  // 9 mm
  EXPECT_EQ(rows[1].group, "mask");
  EXPECT_EQ(rows[1].pairs, 3);
  EXPECT_EQ(rows[1].detected, 2);
  EXPECT_EQ(rows[1].refused, 1);
  EXPECT_EQ(rows[1].wrong, 1);  // 11 degrees
  EXPECT_EQ(rows[3].group, "all");
  EXPECT_EQ(rows[3].pairs, 7);
  EXPECT_EQ(rows[3].wrong, 2);
}

TEST(PerceptionReport, SpreadsTheErrorsOfValidPosesOnly) {
  const auto rows = rows_of(some_results());
  EXPECT_DOUBLE_EQ(rows[0].mouth_m.median, 0.002);
  EXPECT_DOUBLE_EQ(rows[0].mouth_m.max, 0.009);
  EXPECT_NEAR(rows[0].mouth_m.p95, 0.0083, 1e-12);
  EXPECT_DOUBLE_EQ(rows[0].stereo_only_mouth_m.median, 0.001);
  EXPECT_DOUBLE_EQ(rows[1].normal_rad.max, 0.2);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

TEST(PerceptionReport, StatesTimesAsPartsOfAFullPass) {
  const auto stages = stages_of(some_results());
  ASSERT_EQ(stages.size(), 7U);
  EXPECT_EQ(stages[0].pairs, 6);
  EXPECT_DOUBLE_EQ(stages[0].median_s, 0.1);
  EXPECT_NEAR(stages[1].full_passes, 1.2, 1e-12);
  EXPECT_EQ(stages[3].stage, "fresh: face pose");
  EXPECT_NEAR(stages[3].full_passes, 0.2, 1e-12);
  EXPECT_EQ(stages[4].pairs, 1);
  EXPECT_NEAR(stages[4].full_passes, 0.2, 1e-12);
}

TEST(PerceptionReport, IsTheSameAsTableAsJsonAndAsCsv) {
  const auto results = some_results();
  const PerceptionReport report{.detector = "detector/hog",
                                .landmarks = "landmarks/dlib68",
                                .face_pose = "face_pose/three_point",
                                .deployment = "dental_lamp",
                                .rig = "default",
                                .seed = 5,
                                .rows = rows_of(results),
                                .stages = stages_of(results)};
  const std::string text = table(report);
  EXPECT_THAT(text, HasSubstr("mask         3     67 %        1      1"));
  EXPECT_THAT(text, HasSubstr("  2.00   8.30   9.00"));
  EXPECT_THAT(text,
              HasSubstr("detector/hog, landmarks/dlib68, face_pose/three_point as dental_lamp"));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["groups"][1]["wrong_but_valid"], 1);
  EXPECT_EQ(json["groups"][0]["mouth_m"]["max"], 0.009);
  EXPECT_EQ(json["stages"][3]["stage"], "fresh: face pose");
  const std::string csv = csv_of(results);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 8);
  EXPECT_THAT(csv,
              HasSubstr("\nfrontal,0,0,0,1,1,1,0.009,0.01,0.0045,0.005,0.1,0.12,0.05,0.02,\n"));
  EXPECT_THAT(csv, HasSubstr("\nmask,0,0,0,1,0,0,,,,,0.1,0.12,0.05,0.04,\"rows differ, by 7\"\n"));
}

TEST(PerceptionReport, OfNoValidPoseHasNoNumbers) {
  const PerceptionReport report{
      .machine = {}, .rows = rows_of({PairResult{.group = "mask"}}), .stages = stages_of({})};
  EXPECT_THAT(table(report), HasSubstr("     -      -      -"));
  EXPECT_TRUE(nlohmann::json::parse(to_json(report))["groups"][0]["mouth_m"]["median"].is_null());
}

}  // namespace
}  // namespace armature::bench
