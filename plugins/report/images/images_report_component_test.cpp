// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::report::images {
namespace {

using Eigen::Vector3d;

class ImagesReportTest : public testing::Test {
 protected:
  void tell_truth() {
    msg::NeedlePlan truth;
    for (const Vector3d& place :
         {Vector3d{0.09, 0, 0}, Vector3d{0, 0.09, 0}, Vector3d{0, 0, 0.09}}) {
      assign(truth.markers_().emplace_back(), place);
    }
    assign(truth.target_(), Vector3d{0.01, 0, 0.02});
    report_.send("anatomy", truth);
  }
  static msg::ImageMarker marker(const Vector3d& place) {
    msg::ImageMarker marker;
    assign(marker.position_(), place);
    marker.sigma_(0.0001);
    marker.confidence_(0.9);
    return marker;
  }
  static msg::NeedleWays ways() {
    msg::NeedleWays ways;
    ways.valid_(true);
    assign(ways.target_(), Vector3d{0.01, 0.0003, 0.02});
    ways.lesion_volume_(0.9e-6);
    auto& way = ways.ways_().emplace_back();
    way.length_(0.07);
    way.vessel_distance_(0.009);
    way.skull_angle_(0.1);
    way.reason_("because");
    return ways;
  }
  ComponentHarness report_{built_plugins(), {.component = "{plugin: report/images}", .robot = {}}};
};

TEST_F(ImagesReportTest, TellsTheErrorsOfWhatWasFound) {
  tell_truth();
  msg::ImageMarkers markers;
  markers.markers_() = {marker({0.0902, 0, 0}), marker({0, 0.0899, 0}), marker({0.05, 0.05, 0})};
  report_.send("markers", markers);
  report_.send("ways", ways());
  report_.step(0.1);
  const auto told = report_.figures();
  auto figures = told.metrics;
  EXPECT_EQ(figures.at("markers_found"), 2);
  EXPECT_NEAR(figures.at("marker_error_rms_mm"), std::sqrt((0.04 + 0.01) / 2), 1e-9);
  for (const char* key :
       {"max_marker_error_mm", "max_marker_error_sigmas", "min_marker_confidence"}) {
    EXPECT_EQ(figures.count(key), 0u) << "a marker that is not found is worse";
    ASSERT_EQ(told.unmeasured.count(key), 1u) << key;
    EXPECT_EQ(told.unmeasured.at(key), "1 of 3 markers were not found to within 3 mm");
  }
  EXPECT_NEAR(figures.at("lesion_error_mm"), 0.3, 1e-9);
  EXPECT_NEAR(figures.at("lesion_volume_ml"), 0.9, 1e-9);
  EXPECT_NEAR(figures.at("vessel_distance_mm"), 9, 1e-9);
}

TEST_F(ImagesReportTest, TellsTheWorstErrorWhenAllMarkersWereFound) {
  tell_truth();
  msg::ImageMarkers markers;
  markers.markers_() = {marker({0.0902, 0, 0}), marker({0, 0.0899, 0}), marker({0, 0, 0.09})};
  report_.send("markers", markers);
  report_.step(0.1);
  EXPECT_NEAR(report_.figures().metrics.at("max_marker_error_mm"), 0.2, 1e-9);
  EXPECT_NEAR(report_.figures().metrics.at("max_marker_error_sigmas"), 2, 1e-9);
  EXPECT_NEAR(report_.figures().metrics.at("min_marker_confidence"), 0.9, 1e-9);
  markers.markers_()[1].sigma_(NAN);
  report_.send("markers", markers);
  report_.step(0.2);
  EXPECT_EQ(report_.figures().metrics.count("max_marker_error_sigmas"), 0u);
  EXPECT_EQ(report_.figures().unmeasured["max_marker_error_sigmas"],
            "a marker's sigma or confidence is no number");
}

TEST_F(ImagesReportTest, WithoutAVesselItsDistanceDoesNotApply) {
  msg::NeedleWays far = ways();
  far.ways_()[0].vessel_distance_(INFINITY);
  report_.send("ways", far);
  report_.step(0.1);
  EXPECT_EQ(report_.figures().inapplicable["vessel_distance_mm"], "no vessel was found");
}

TEST_F(ImagesReportTest, TellsNothingOfWhatNobodyFound) {
  tell_truth();
  report_.step(0.1);
  EXPECT_TRUE(report_.figures().metrics.empty());
  report_.send("markers", msg::ImageMarkers{});
  report_.step(0.2);
  EXPECT_EQ(report_.figures().metrics.size(), 1u);
  EXPECT_EQ(report_.figures().metrics.at("markers_found"), 0);
}

TEST_F(ImagesReportTest, WritesAllWaysWithTheirReasons) {
  const TemporaryFolder folder;
  report_.send("ways", ways());
  report_.step(0.1);
  report_.component().write_files(folder.path());
  std::ifstream file{folder / "needle_ways.csv"};
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  EXPECT_EQ(line, "0.00,0.00,0.00,70.00,9.00,5.73,0.000,\"because\"");
}

}  // namespace
}  // namespace armature::report::images
