// SPDX-License-Identifier: Apache-2.0
#include "unfinished_scenario.hpp"

#include <gtest/gtest.h>

namespace armature::report::lamp_alignment {
namespace {

constexpr Time at(double t_s) { return Time{} + seconds(t_s); }

TEST(UnfinishedScenario, OfWhichNothingWasHeardTellsNothing) {
  EXPECT_EQ(UnfinishedScenario{}.told(at(3)), "");
}

TEST(UnfinishedScenario, TellsWhyTheLastFaceThatWasSeenWasRefused) {
  UnfinishedScenario scenario;
  scenario.see_face(at(1));
  scenario.see_face(at(1.1));
  scenario.see_refusal(at(1), "too wide");
  scenario.see_refusal(at(1.1), "too narrow");
  scenario.see_refusal(at(1.2), "no face in the left image");
  EXPECT_EQ(scenario.told(at(2)), "; the last that was seen was refused: too narrow");
  scenario.see_estimate();
  EXPECT_EQ(scenario.told(at(2)), "");
}

TEST(UnfinishedScenario, RemembersTheFacesOfTheNewestPictures) {
  UnfinishedScenario scenario;
  for (int i = 0; i <= 64; ++i) scenario.see_face(at(i));
  scenario.see_refusal(at(0), "forgotten");
  EXPECT_EQ(scenario.told(at(65)), "");
  scenario.see_refusal(at(1), "the oldest");
  EXPECT_EQ(scenario.told(at(65)), "; the last that was seen was refused: the oldest");
}

TEST(UnfinishedScenario, TellsWhatTheTaskWasAtAndForHowLong) {
  UnfinishedScenario scenario;
  scenario.see_task("checking light", "", at(1));
  scenario.see_task("searching 1/9", "", at(2));
  scenario.see_task("searching 1/9", "", at(3));
  EXPECT_EQ(scenario.told(at(4.5)), "; the task had been searching 1/9 for 2.5 s");
  scenario.see_task("unreachable", "out_of_reach", at(5));
  EXPECT_EQ(scenario.told(at(6)), "; the task had been unreachable for 1.0 s: out_of_reach");
}

}  // namespace
}  // namespace armature::report::lamp_alignment
