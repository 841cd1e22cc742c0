// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "armature/kinds/ik/contract/law.hpp"
#include "armature/robot/kinematics.hpp"
#include "armature/values/allocation_count.hpp"

// The laws of the kind `ik` as tests. In the plugin's test, in one source file of the program:
//
//   INSTANTIATE_TEST_SUITE_P(Lamp, IkLaws, testing::Values(IkSubject{.name = "lamp", ...}));
namespace armature {

/// Tools that count allocations, where no sanitizer brings its own.
inline IkLawTools counting_tools() {
  IkLawTools tools;
#ifdef ARMATURE_COUNTS_ALLOCATIONS
  tools.allocations = [] { return allocation_count; };
#endif
  return tools;
}

/// Checks a law and fails with the first answers that break it.
inline void expect_kept(const IkLaw& law, const IkSubject& subject) {
  const IkLawReport report = check_law(law, subject, counting_tools());
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  EXPECT_EQ(report.failed, 0) << "of " << report.goals << " questions, seed " << subject.seed;
  for (const auto& [what, question] : report.violations) ADD_FAILURE() << what << "\n" << question;
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
