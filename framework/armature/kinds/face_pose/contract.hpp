// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/face_pose/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `face_pose` as tests. In the plugin's test, in one source file of the
// program:
//
//   INSTANTIATE_TEST_SUITE_P(ThreePoint, FacePoseLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class FacePoseLaws : public testing::TestWithParam<FacePoseSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FacePoseLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(FacePoseLaws, Name) { expect_kept(face_pose_laws(), #Name, GetParam()); }
ARMATURE_FACE_POSE_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
