// SPDX-License-Identifier: Apache-2.0
#include "armature/laws/law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature {
namespace {

struct Nobody {};

TEST(LawCheck, AClaimThatHoldsLeavesNothing) {
  LawCheck check;
  EXPECT_TRUE(check.that(true, "one is one"));
  EXPECT_TRUE(check.at_most(1, 1, "one"));
  EXPECT_TRUE(check.near(1, 1.1, 0.2, "one"));
  EXPECT_TRUE(check.equal(std::string{"a"}, "a", "the letter"));
  EXPECT_TRUE(check.answered(Expected<int>{3}, "it"));
  EXPECT_TRUE(check.refused(Expected<int>{refuse("no")}, "it"));
  EXPECT_TRUE(check.refused_with(Expected<int>{refuse("no")}, "no"));
  EXPECT_TRUE(check.report().kept());
  EXPECT_TRUE(check.report().violations.empty());
}

TEST(LawCheck, AViolationSaysQuantityValueBoundAndQuestion) {
  LawCheck check;
  check.asks("seed 1, round 2");
  EXPECT_FALSE(check.that(false, "the path ends at rest"));
  EXPECT_FALSE(check.at_most(2, 1, "the gap [m]"));
  EXPECT_FALSE(check.near(2, 1, 0.5, "the length"));
  EXPECT_FALSE(check.equal(2, 1, "the count"));
  EXPECT_FALSE(check.equal(std::vector<Nobody*>{nullptr}, std::vector<Nobody*>{}, "the list"));
  std::vector<std::string> told;
  for (const LawViolation& violation : check.report().violations) {
    EXPECT_EQ(violation.question, "seed 1, round 2");
    told.push_back(violation.what);
  }
  EXPECT_EQ(told,
            (std::vector<std::string>{"it does not hold that the path ends at rest",
                                      "the gap [m]: 2, more than 1", "the length: 2, not 1 to 0.5",
                                      "the count: '2', not '1'", "the list is another one"}));
  EXPECT_EQ(check.report().questions, 1);
}

TEST(LawCheck, AnswersAndRefusalsAreToldApart) {
  LawCheck check;
  EXPECT_FALSE(check.answered(Expected<int>{refuse("no")}, "a good goal"));
  EXPECT_FALSE(check.refused(Expected<int>{3}, "a bad goal"));
  EXPECT_FALSE(check.refused(Expected<int>{refuse("")}, "a bad goal"));
  EXPECT_FALSE(check.refused_with(Expected<int>{refuse("no")}, "not finite"));
  EXPECT_FALSE(check.refused_with(Expected<int>{3}, "not finite"));
  std::vector<std::string> told;
  for (const LawViolation& violation : check.report().violations) told.push_back(violation.what);
  EXPECT_EQ(told,
            (std::vector<std::string>{
                "a good goal is refused: no", "a bad goal is answered, not refused",
                "it does not hold that a refusal says why", "the reason: 'no', not 'not finite'",
                "answered, not refused with 'not finite'"}));
}

TEST(LawCheck, ANumberThatIsNoneKeepsNoBound) {
  LawCheck check;
  EXPECT_FALSE(check.at_most(std::nan(""), 1, "the gap"));
  EXPECT_FALSE(check.near(std::nan(""), 1, 10, "the length"));
}

TEST(LawCheck, AllViolationsAreCountedAndTheFirstFiveKept) {
  LawCheck check;
  for (int i = 0; i < 20; ++i) check.equal(i, -1, "the number");
  EXPECT_EQ(check.report().failed, 20);
  ASSERT_EQ(check.report().violations.size(), 5u);
  EXPECT_EQ(check.report().violations.front().what, "the number: '0', not '-1'");
}

TEST(CheckLaw, AnExceptionOfThePluginBreaksTheLaw) {
  const Law<Nobody> law{"Stays", "it stays",
                        [](const Nobody&, LawCheck&) { throw std::runtime_error{"gone"}; }};
  const LawReport report = check_law(law, Nobody{});
  EXPECT_EQ(report.failed, 1);
  EXPECT_EQ(report.violations.at(0).what, "it throws: gone");
  const Law<Nobody> odd{"Stays", "it stays", [](const Nobody&, LawCheck&) { throw 7; }};
  EXPECT_EQ(check_law(odd, Nobody{}).violations.at(0).what, "it throws what is no std::exception");
}

}  // namespace
}  // namespace armature
