// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>
#include <string>

#include "armature/kinds/ik/contract/law.hpp"
#include "armature/laws/googletest.hpp"
#include "armature/values/allocation_count.hpp"

// The laws of the kind `ik` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Lamp, IkLaws, testing::Values(IkLawCase{"lamp", [] {
//     return IkSubject{.model = ..., .solver = ...};
//   }}), testing::PrintToStringParamName());
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

/// A solver on a robot, made by the test that asks it. CTest runs every test as a program of its
/// own, which has no use for the solvers of the others.
struct IkLawCase {
  std::string name;
  std::function<IkSubject()> make;

  friend void PrintTo(const IkLawCase& one, std::ostream* out) { *out << one.name; }
};

class IkLaws : public testing::TestWithParam<IkLawCase> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(IkLaws);

#define ARMATURE_IK_LAW_TEST(Name, function, says)                \
  TEST_P(IkLaws, Name) {                                          \
    for (const IkLaw& law : ik_laws()) {                          \
      if (law.name == #Name) expect_kept(law, GetParam().make()); \
    }                                                             \
  }
ARMATURE_IK_LAWS(ARMATURE_IK_LAW_TEST)
#undef ARMATURE_IK_LAW_TEST

}  // namespace armature
