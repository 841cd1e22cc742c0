// SPDX-License-Identifier: Apache-2.0
// The planner on its topics: a plan for a sound volume, a reason for every other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "armature/volume/nrrd.hpp"
#include "small_head_test.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

class NeedlePlannerTest : public testing::Test {
 protected:
  void announce(const SmallHead& head) {
    const Volume volume = head.scan();
    ASSERT_TRUE(write_nrrd(volume, file_));
    msg::VolumeFile message;
    message.path_(file_.string());
    message.sha256_(sha256_of(volume));
    planner_.send("volume", message);
  }
  void find_markers(std::size_t count, double taken_s = 0) {
    msg::ImageMarkers message;
    set_stamp(message.header_().stamp_(), Time{} + seconds(taken_s));
    message.valid_(true);
    for (std::size_t i = 0; i < count; ++i) {
      assign(message.markers_().emplace_back().position_(),
             Vector3d{0.05 * std::cos(static_cast<double>(i)),
                      0.05 * std::sin(static_cast<double>(i)), -0.01});
      message.markers_().back().radius_(0.005);
    }
    planner_.send("markers", message);
  }
  void expect_refused(const std::string& reason) {
    planner_.step(0.1);
    const auto ways = planner_.take<msg::NeedleWays>("ways");
    ASSERT_EQ(ways.size(), 1u);
    EXPECT_FALSE(ways[0].valid_());
    EXPECT_THAT(ways[0].reason_(), HasSubstr(reason));
    EXPECT_TRUE(planner_.take<msg::NeedlePlan>("plan").empty());
    EXPECT_TRUE(planner_.component().finished());
    EXPECT_EQ(planner_.figures().status, "refused");
    EXPECT_EQ(planner_.figures().reason, ways[0].reason_());
  }

  static SmallHead sound() {
    SmallHead head;
    head.with(lesion_at({0.005, 0, 0.008}))
        .with(vessel_along({-0.012, 0.01, 0.02}, {0.004, 0.014, 0.02}));
    return head;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "volume.nrrd";
  ComponentHarness planner_{
      built_plugins(),
      {.component = "{plugin: image/needle_planner, params: {markers: 4}}", .robot = {}}};
};

TEST_F(NeedlePlannerTest, PlansTheBestWayOnce) {
  announce(sound());
  planner_.step(0.05);
  EXPECT_TRUE(planner_.take<msg::NeedleWays>("ways").empty());
  find_markers(4);
  EXPECT_TRUE(planner_.triggered());
  planner_.step(0.1);
  planner_.step(0.2);
  const auto ways = planner_.take<msg::NeedleWays>("ways");
  const auto plans = planner_.take<msg::NeedlePlan>("plan");
  ASSERT_EQ(ways.size(), 1u);
  ASSERT_EQ(plans.size(), 1u);
  EXPECT_TRUE(ways[0].valid_()) << ways[0].reason_();
  EXPECT_EQ(plans[0].header_().frame_id_(), "image");
  EXPECT_EQ(plans[0].markers_().size(), 4u);
  EXPECT_EQ(plans[0].forbidden_().size(), 1u);
  ASSERT_EQ(plans[0].head_().size(), 1u);
  EXPECT_NEAR(plans[0].head_()[0].radius_(), kSmallSkin, 0.001);
  EXPECT_EQ(plans[0].entry_(), ways[0].ways_()[0].entry_());
  EXPECT_LT((to_eigen(plans[0].target_()) - Vector3d{0.005, 0, 0.008}).norm(), 0.0002);
  EXPECT_THAT(ways[0].ways_()[0].reason_(), HasSubstr("vessel 1 is "));
  EXPECT_FALSE(planner_.component().finished());
}

TEST_F(NeedlePlannerTest, WaitsForTheMarkersOfTheVolumeThatWasAnnouncedLast) {
  announce(sound());
  find_markers(4, 99.0);
  planner_.step(0.1);
  EXPECT_TRUE(planner_.take<msg::NeedleWays>("ways").empty());
  find_markers(4);
  planner_.step(0.2);
  EXPECT_EQ(planner_.take<msg::NeedleWays>("ways").size(), 1u);
}

TEST_F(NeedlePlannerTest, RefusesAVolumeWithoutItsMarkersByTheirNumber) {
  announce(sound());
  find_markers(3);
  expect_refused("3 of 4 markers were found in the volume");
}

TEST_F(NeedlePlannerTest, RefusesAVolumeWithoutAnyMarker) {
  announce(sound());
  find_markers(0);
  expect_refused("no marker was found in the volume");
}

TEST_F(NeedlePlannerTest, RefusesMoreMarkersThanTheHeadHas) {
  announce(sound());
  find_markers(5);
  expect_refused("5 of 4 markers were found in the volume: something else looks like one");
}

TEST_F(NeedlePlannerTest, RefusesAVolumeWithoutALesion) {
  announce(SmallHead{});
  find_markers(4);
  expect_refused("no lesion was found");
}

TEST_F(NeedlePlannerTest, RefusesATruncatedFile) {
  announce(sound());
  std::filesystem::resize_file(file_, 100000);
  find_markers(4);
  expect_refused("is it truncated?");
}

TEST(NeedlePlannerParameters, ThatAreNoPlaceOrNoDirectionAreRefused) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(
        built_plugins(),
        {.component = "{plugin: image/needle_planner, params: {" + params + "}}", .robot = {}});
  };
  EXPECT_THAT(refusal("lesion_near_mm: [1, 2]"), HasSubstr("'lesion_near_mm' has 2 numbers"));
  EXPECT_THAT(refusal("approach: [0, 0, 0]"), HasSubstr("'approach' is no direction"));
}

}  // namespace
}  // namespace armature::image::needle_planner
