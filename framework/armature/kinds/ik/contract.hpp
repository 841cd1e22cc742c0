// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/contract/law.hpp"
#include "armature/laws/googletest.hpp"
#include "armature/values/allocation_count.hpp"

// The laws of the kind `ik` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Lamp, IkLaws, testing::Values(IkSubject{.name = "lamp", ...}));
namespace armature ARMATURE_EXPORT {

/// Tools that count allocations, where no sanitizer brings its own.
inline IkLawTools counting_tools() {
  IkLawTools tools;
#ifdef ARMATURE_COUNTS_ALLOCATIONS
  tools.allocations = [] { return allocation_count; };
#endif
  return tools;
}

inline void expect_kept(const IkLaw& law, const IkSubject& subject) {
  expect_kept(check_law(law, subject, counting_tools()));
}

class IkLaws : public testing::TestWithParam<IkSubject> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(IkLaws);

#define ARMATURE_IK_LAW_TEST(Name, function, says)         \
  TEST_P(IkLaws, Name) {                                   \
    for (const IkLaw& law : ik_laws()) {                   \
      if (law.name == #Name) expect_kept(law, GetParam()); \
    }                                                      \
  }
ARMATURE_IK_LAWS(ARMATURE_IK_LAW_TEST)
#undef ARMATURE_IK_LAW_TEST

}  // namespace armature
