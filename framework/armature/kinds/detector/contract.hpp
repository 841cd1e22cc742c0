// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/detector/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `detector` as tests. In the plugin's test, in one source file of the
// program:
//
//   INSTANTIATE_TEST_SUITE_P(Hog, DetectorLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class DetectorLaws : public testing::TestWithParam<DetectorSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DetectorLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(DetectorLaws, Name) { expect_kept(detector_laws(), #Name, GetParam()); }
ARMATURE_DETECTOR_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
