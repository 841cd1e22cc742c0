// SPDX-License-Identifier: Apache-2.0
// Where everything is in an operating room: 1. the chain from the parameters, 2. lists that do not
// come out, 3. the drill in the hand.
#include "operating_room.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "armature/kinds/declared_params.hpp"
#include "tests/refusal.hpp"

namespace armature::sim::optical_tracker {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::EndsWith;
using ::testing::HasSubstr;

Isometry3d file_tool() {
  return Eigen::Translation3d{0, 0.02, 0.15} * Eigen::AngleAxisd{0.5, Vector3d::UnitY()};
}

OperatingRoom room(const std::string& given = "") {
  const Params params = declared_params(
      ARMATURE_SOURCE_DIR "/plugins/sim/optical_tracker/plugin.yaml", "{" + given + "}");
  return operating_room(Parameters::read(params), params, file_tool());
}

TEST(OperatingRoom, TheDrillsTipIsOffItsPlaceInTheFileAlongTheToolsAxes) {
  const GuidedChain chain = room("drill_offset_mm: [1, -2, 3]").chain;
  const Isometry3d tool = chain.flange_T_tool();
  EXPECT_LT((file_tool().inverse() * tool.translation() - Vector3d{0.001, -0.002, 0.003}).norm(),
            1e-15);
  EXPECT_LT((tool.linear() - file_tool().linear()).norm(), 1e-15) << "its axis is as in the file";
}

TEST(OperatingRoom, JawAndTrackerStandInTheBaseFrame) {
  const OperatingRoom there = room(
      "jaw_mm: [100, 200, 300], jaw_rpy_deg: [0, 0, 90], image_mm: [10, 0, 0], image_rpy_deg: [0, "
      "0, 0], sites_mm: [0, 0, 5], sites_rpy_deg: [180, 0, 0], tracker_mm: [-1000, 0, 0]");
  ASSERT_EQ(there.sites.size(), 1u);
  const Isometry3d site = there.chain.base_T_site(there.sites.front());
  EXPECT_LT((site.translation() - Vector3d{0.1, 0.21, 0.305}).norm(), 1e-12);
  EXPECT_LT((site.linear().col(2) - Vector3d{0, 0, -1}).norm(), 1e-12);
  EXPECT_LT((there.chain.base_T_tracker.translation() - Vector3d{-1, 0, 0}).norm(), 1e-15);
  EXPECT_EQ(there.markers.size(), 6u);
}

TEST(OperatingRoom, ListsThatDoNotComeOutAreRefused) {
  const auto refusal = [](const std::string& params) -> std::string {
    return test::refusal_of([&] { room(params); });
  };
  EXPECT_EQ(refusal("sites_mm: [1, 2]"),
            "given:1:12: 'sites_mm' has 2 numbers; three for each of at least one site are needed");
  EXPECT_EQ(refusal("sites_mm: []"),
            "given:1:12: 'sites_mm' has 0 numbers; three for each of at least one site are needed");
  EXPECT_EQ(refusal("sites_rpy_deg: [1, 2, 3]"),
            "given:1:17: 'sites_mm' has 3 sites, 'sites_rpy_deg' has 1");
  EXPECT_EQ(refusal("markers_mm: [0, 0, 0, 1, 1, 1]"),
            "given:1:14: 'markers_mm' has 6 numbers; three for each of at least three markers are "
            "needed");
}

TEST(OperatingRoom, AnImplantThatCannotBeIsRefusedWithWhatIsWanted) {
  const auto refusal = [](const std::string& second) -> std::string {
    return test::refusal_of([&] {
      room(
          "sites_mm: [0, 0, 5, 10, 0, 5], sites_rpy_deg: [180, 0, 0, 180, 0, 0], "
          "implants_mm: [0.5, 11, 1.2, " +
          second + "]");
    });
  };
  EXPECT_EQ(refusal("0, 100, 0.1"), "");
  EXPECT_THAT(refusal("0.5, 0, 1.2"),
              EndsWith(": 'implants_mm': of implant 2 its length is 0 mm, more than 0 and at most "
                       "100 are wanted"));
  EXPECT_THAT(refusal("0.5, 11000, 1.2"), HasSubstr("its length is 11000 mm"));
  EXPECT_THAT(refusal("0.5, 11, 0"),
              EndsWith(": 'implants_mm': of implant 2 its pitch is 0 mm, from 0.1 to its length "
                       "are wanted"));
  EXPECT_THAT(refusal("0.5, 11, 12"), HasSubstr("its pitch is 12 mm"));
  EXPECT_THAT(refusal("500, 11, 1.2"),
              HasSubstr("its end above the bottom is 500 mm, at most 100 are wanted"));
  EXPECT_THAT(refusal("0.5, 11, -1.2"), HasSubstr("'implants_mm' item 6 is -1.2"));
}

TEST(OperatingRoom, TheDrillTurnsAboutItsTipWithinTheConeAndAboutManyAxes) {
  const Vector3d tip{0.01, -0.02, 0.15}, divot{0.1, 0.2, 1.5};
  Vector3d tilts = Vector3d::Zero();
  double most = 0;
  for (double t = 0; t < 2; t += 0.01) {
    const Isometry3d pose = turned_about_tip(tip, divot, 0.8, t);
    EXPECT_LT((pose * tip - divot).norm(), 1e-15);
    const Vector3d axis = pose.linear().col(2);
    const double tilt = std::acos(std::min(1.0, axis.z()));
    EXPECT_LE(tilt, 0.8 + 1e-12);
    most = std::max(most, tilt);
    tilts += axis / 200;
  }
  EXPECT_GT(most, 0.79);
  EXPECT_LT(tilts.head<2>().norm(), 0.1) << "to all sides";
}

}  // namespace
}  // namespace armature::sim::optical_tracker
