// SPDX-License-Identifier: Apache-2.0
#include "unfinished_scenario.hpp"

#include <gtest/gtest.h>

namespace armature::report::lamp_alignment {
namespace {

constexpr Time at(double t_s) { return Time{} + seconds(t_s); }

TEST(UnfinishedScenario, OfWhichNothingWasHeardTellsNothing) {
  EXPECT_EQ(UnfinishedScenario{}.told(at(3)), "");
}

TEST(UnfinishedScenario, TellsWhyMostOfTheFacesThatWereSeenWereRefused) {
  UnfinishedScenario scenario;
  const auto refuse = [&](double t_s, std::uint8_t code, const char* why) {
    scenario.see_face(at(t_s));
    scenario.see_code(at(t_s), code);
    scenario.see_refusal(at(t_s), why);
  };
  refuse(1, 5, "rows differ by 1 px");
  EXPECT_EQ(scenario.told(at(2)), "; a picture of a face was refused: rows differ by 1 px");
  scenario.see_refusal(at(1.05), "no face in the left image");
  refuse(1.1, 5, "rows differ by 2 px");
  refuse(1.2, 7, "shows too little");
  EXPECT_EQ(scenario.told(at(2)),
            "; of 3 pictures of a face that were refused most (2) were so: rows differ by 2 px");
  scenario.see_estimate();
  EXPECT_EQ(scenario.told(at(2)), "");
}

TEST(UnfinishedScenario, RemembersTheFacesOfTheNewestPictures) {
  UnfinishedScenario scenario;
  for (int i = 0; i <= 64; ++i) scenario.see_face(at(i));
  scenario.see_refusal(at(0), "forgotten");
  EXPECT_EQ(scenario.told(at(65)), "");
  scenario.see_refusal(at(1), "the oldest");
  EXPECT_EQ(scenario.told(at(65)), "; a picture of a face was refused: the oldest");
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
