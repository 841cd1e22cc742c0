// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/component/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of components as tests. In one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Mine, ComponentLaws, testing::Values(ComponentSubject{...}));
namespace armature {

class ComponentLaws : public testing::TestWithParam<ComponentSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ComponentLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(ComponentLaws, Name) { expect_kept(component_laws(), #Name, GetParam()); }
ARMATURE_COMPONENT_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
