// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/target/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `target` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(ConstantVelocity, TargetLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class TargetLaws : public testing::TestWithParam<TargetSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TargetLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(TargetLaws, Name) { expect_kept(target_laws(), #Name, GetParam()); }
ARMATURE_TARGET_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
