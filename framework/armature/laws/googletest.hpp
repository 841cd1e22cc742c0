// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string_view>

#include "armature/laws/law.hpp"

namespace armature ARMATURE_EXPORT {

/// A GoogleTest of one law: fails with the first answers that break it.
inline void expect_kept(const LawReport& report) {
  if (!report.skipped.empty()) GTEST_SKIP() << report.skipped;
  EXPECT_EQ(report.failed, 0) << "claims, in " << report.questions << " questions";
  for (const auto& [what, question] : report.violations) ADD_FAILURE() << what << "\n" << question;
}

template <class Subject>
void expect_kept(std::span<const Law<Subject>> laws, std::string_view name,
                 const Subject& subject) {
  for (const Law<Subject>& law : laws) {
    if (law.name == name) return expect_kept(check_law(law, subject));
  }
  FAIL() << "there is no law " << name;
}

}  // namespace armature
