// SPDX-License-Identifier: Apache-2.0
#include "joint_move.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/path/contract.hpp"

namespace armature::path::joint_move {
namespace {

INSTANTIATE_TEST_SUITE_P(
    JointMove, PathLaws,
    testing::Values(PathSubject{"fast", std::make_shared<JointMove>(Parameters{})},
                    PathSubject{"timed", std::make_shared<JointMove>(Parameters{.duration = 5})}),
    testing::PrintToStringParamName());

TEST(JointMove, IsOneJointSegmentThatLastsAsLongAsItWasTold) {
  const PathRequest request{.start = {{0, 0, 1}, Eigen::Quaterniond::Identity()},
                            .goal = {{1, 0, 0}, Eigen::Quaterniond{0.6, 0.8, 0, 0}}};
  const auto path = JointMove{{.duration = 5}}.plan(request);
  ASSERT_TRUE(path);
  ASSERT_EQ(path->size(), 1u);
  EXPECT_EQ(path->front().space, PathSegment::Space::joint);
  EXPECT_EQ(path->front().samples.size(), 1u);
  EXPECT_EQ(path->front().duration_s, 5);
  EXPECT_FALSE(JointMove{Parameters{}}.plan(request)->front().duration_s);
}

}  // namespace
}  // namespace armature::path::joint_move
