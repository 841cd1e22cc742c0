// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/landmarks/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `landmarks` as tests. In the plugin's test, in one source file of the
// program:
//
//   INSTANTIATE_TEST_SUITE_P(Dlib68, LandmarkLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class LandmarkLaws : public testing::TestWithParam<LandmarkSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LandmarkLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(LandmarkLaws, Name) { expect_kept(landmark_laws(), #Name, GetParam()); }
ARMATURE_LANDMARK_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
