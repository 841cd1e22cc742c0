// SPDX-License-Identifier: Apache-2.0
#include "unfinished_story.hpp"

#include <gtest/gtest.h>

namespace armature::report::lamp_alignment {
namespace {

constexpr Time at(double t_s) { return Time{} + seconds(t_s); }

TEST(UnfinishedStory, OfWhichNothingWasHeardTellsNothing) {
  EXPECT_EQ(UnfinishedStory{}.told(at(3)), "");
}

TEST(UnfinishedStory, TellsWhyTheLastFaceThatWasSeenWasRefused) {
  UnfinishedStory story;
  story.see_face(at(1));
  story.see_face(at(1.1));
  story.see_refusal(at(1), "too wide");
  story.see_refusal(at(1.1), "too narrow");
  story.see_refusal(at(1.2), "no face in the left image");
  EXPECT_EQ(story.told(at(2)), "; the last that was seen was refused: too narrow");
  story.see_estimate();
  EXPECT_EQ(story.told(at(2)), "");
}

TEST(UnfinishedStory, RemembersTheFacesOfTheNewestPictures) {
  UnfinishedStory story;
  for (int i = 0; i <= 64; ++i) story.see_face(at(i));
  story.see_refusal(at(0), "forgotten");
  EXPECT_EQ(story.told(at(65)), "");
  story.see_refusal(at(1), "the oldest");
  EXPECT_EQ(story.told(at(65)), "; the last that was seen was refused: the oldest");
}

TEST(UnfinishedStory, TellsWhatTheTaskWasAtAndForHowLong) {
  UnfinishedStory story;
  story.see_task("checking light", "", at(1));
  story.see_task("searching 1/9", "", at(2));
  story.see_task("searching 1/9", "", at(3));
  EXPECT_EQ(story.told(at(4.5)), "; the task had been searching 1/9 for 2.5 s");
  story.see_task("unreachable", "out_of_reach", at(5));
  EXPECT_EQ(story.told(at(6)), "; the task had been unreachable for 1.0 s: out_of_reach");
}

}  // namespace
}  // namespace armature::report::lamp_alignment
