// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/registration/laws.hpp"
#include "armature/laws/googletest.hpp"

// The laws of the kind `registration` as tests. In the plugin's test, in one source file of the
// program:
//
//   INSTANTIATE_TEST_SUITE_P(Rigid, RegistrationLaws, testing::Values(...));
namespace armature ARMATURE_EXPORT {

class RegistrationLaws : public testing::TestWithParam<RegistrationSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RegistrationLaws);

#define ARMATURE_LAW_TEST(Name, function, says) \
  TEST_P(RegistrationLaws, Name) { expect_kept(registration_laws(), #Name, GetParam()); }
ARMATURE_REGISTRATION_LAWS(ARMATURE_LAW_TEST)
#undef ARMATURE_LAW_TEST

}  // namespace armature
