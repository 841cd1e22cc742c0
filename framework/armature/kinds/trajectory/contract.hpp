// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `trajectory` as tests. In the plugin's test, in one source file of the
// program:
//
//   INSTANTIATE_TEST_SUITE_P(Quintic, TrajectoryLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class TrajectoryLaws : public testing::TestWithParam<TrajectorySubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TrajectoryLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(TrajectoryLaws, Name) { expect_kept(trajectory_laws(), #Name, GetParam()); }
ARMATURE_TRAJECTORY_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
