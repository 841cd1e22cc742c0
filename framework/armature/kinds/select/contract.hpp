// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/select/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `select` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Nearest, SelectLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class SelectLaws : public testing::TestWithParam<SelectSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SelectLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(SelectLaws, Name) { expect_kept(select_laws(), #Name, GetParam()); }
ARMATURE_SELECT_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
