// SPDX-License-Identifier: Apache-2.0
#include "joint_move.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/path/contract.hpp"

namespace armature {
namespace {

std::shared_ptr<const PathPlanner> joint_move(std::string_view params) {
  return JointMove::make(
             declared_params(ARMATURE_SOURCE_DIR "/plugins/path/joint_move/plugin.yaml", params))
      .value();
}

INSTANTIATE_TEST_SUITE_P(JointMove, PathLaws,
                         testing::Values(PathSubject{"fast", joint_move("")},
                                         PathSubject{"timed", joint_move("duration_s: 5")}),
                         testing::PrintToStringParamName());

TEST(JointMove, IsOneJointSegmentThatLastsAsLongAsItWasTold) {
  const PathRequest request{.start = {{0, 0, 1}, Eigen::Quaterniond::Identity()},
                            .goal = {{1, 0, 0}, Eigen::Quaterniond{0.6, 0.8, 0, 0}},
                            .focus = {}};
  const auto path = joint_move("duration_s: 5")->plan(request);
  ASSERT_TRUE(path);
  ASSERT_EQ(path->size(), 1u);
  EXPECT_EQ(path->front().space, PathSegment::Space::joint);
  EXPECT_EQ(path->front().samples.size(), 1u);
  EXPECT_EQ(path->front().duration_s, 5);
  EXPECT_FALSE(joint_move("")->plan(request)->front().duration_s);
}

}  // namespace
}  // namespace armature
