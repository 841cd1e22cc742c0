// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `path` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(MouthArc, PathLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class PathLaws : public testing::TestWithParam<PathSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PathLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(PathLaws, Name) { expect_kept(path_laws(), #Name, GetParam()); }
ARMATURE_PATH_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
