// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/markers/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `markers` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Spheres, MarkerLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class MarkerLaws : public testing::TestWithParam<MarkerSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(MarkerLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(MarkerLaws, Name) { expect_kept(marker_laws(), #Name, GetParam()); }
ARMATURE_MARKER_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
