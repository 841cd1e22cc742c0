// SPDX-License-Identifier: Apache-2.0
// The simulated head on its topics: told once, and refused when it is no head.
#include <gtest/gtest.h>

#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::marked_head {
namespace {

ComponentHarness::Options head_with(const std::string& params) {
  return {.component = "{plugin: sim/marked_head, params: {" + params + "}}", .robot = {}};
}

std::string refusal(const std::string& params) {
  return refusal_of(built_plugins(), head_with(params));
}

TEST(MarkedHeadComponentTest, TellsPlanMarkersAndTruthOnce) {
  ComponentHarness head{built_plugins(),
                        head_with("head_mm: [100, 200, 300], head_rpy_deg: [0, 0, 90], "
                                  "marker_error_mm: 0, spurious_points: 0")};
  head.step(0.1);
  const auto plans = head.take<msg::NeedlePlan>("plan");
  ASSERT_EQ(plans.size(), 1u);
  EXPECT_EQ(plans[0].header_().frame_id_(), "image");
  EXPECT_EQ(plans[0].markers_().size(), 6u);
  EXPECT_LT((to_eigen(plans[0].target_()) - Eigen::Vector3d{0.01, 0.005, 0.012}).norm(), 1e-15);
  ASSERT_EQ(plans[0].forbidden_().size(), 2u);
  EXPECT_EQ(plans[0].forbidden_()[1].name_(), "vessel 2");
  EXPECT_DOUBLE_EQ(plans[0].forbidden_()[1].radius_(), 0.005);
  ASSERT_EQ(plans[0].head_().size(), 1u);
  EXPECT_EQ(to_eigen(plans[0].head_()[0].from_()), Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(plans[0].head_()[0].radius_(), 0.083);
  const auto markers = head.take<msg::MeasuredMarkers>("markers");
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(markers[0].header_().frame_id_(), "base");
  EXPECT_EQ(markers[0].points_().size(), 6u);
  const auto truths = head.take<msg::TransformStamped>("truth");
  ASSERT_EQ(truths.size(), 1u);
  EXPECT_EQ(truths[0].child_frame_id_(), "image");
  const Eigen::Vector3d x = to_eigen(truths[0].transform_()) * Eigen::Vector3d{0.1, 0, 0};
  EXPECT_LT((x - Eigen::Vector3d{0.1, 0.3, 0.3}).norm(), 1e-15);
  head.step(0.2);
  EXPECT_TRUE(head.take<msg::NeedlePlan>("plan").empty());
}

TEST(MarkedHeadComponentTest, RefusesListsThatDoNotComeOut) {
  EXPECT_NE(refusal("markers_mm: [1, 2, 3, 4]")
                .find("'markers_mm' has 4 numbers; three for each of "
                      "at least three markers are needed"),
            std::string::npos);
  EXPECT_NE(refusal("vessels_mm: [1, 2, 3]").find("'vessels_mm' has 3 numbers; seven for each"),
            std::string::npos);
  EXPECT_NE(refusal("vessels_mm: [1, 2, 3, 4, 5, 6, -1]")
                .find("'vessels_mm' item 7 is -1, but a vessel's radius is at least 0"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::sim::marked_head
