// SPDX-License-Identifier: Apache-2.0
// What an operator may say to a task, and when.
#include "armature/task/procedure.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using State = Procedure::StepState;

class ProcedureTest : public ::testing::Test {
 protected:
  std::string refusal(const std::string& word, const std::string& step = "") {
    const auto said = procedure_.hear({.id = 1, .word = word, .step = step});
    return said ? "" : said.error().text;
  }
  static std::vector<Procedure::Step> steps() {
    return {{"registration"}, {"approach", true}, {"insertion", true}};
  }
  Procedure procedure_{steps(), false};
};

TEST_F(ProcedureTest, AStepThatMovesTowardsThePatientWaitsForItsConfirmation) {
  EXPECT_TRUE(procedure_.may_act());
  procedure_.enter_next();
  EXPECT_TRUE(procedure_.asks());
  EXPECT_FALSE(procedure_.may_act());
  EXPECT_EQ(procedure_.state_of(0), State::done);
  EXPECT_EQ(procedure_.state_of(1), State::asks);
  EXPECT_EQ(procedure_.state_of(2), State::ahead);
  EXPECT_EQ(refusal("confirm", "approach"), "");
  EXPECT_TRUE(procedure_.may_act());
  EXPECT_EQ(procedure_.state_of(1), State::active);
  procedure_.enter_next();
  EXPECT_TRUE(procedure_.asks());
}

TEST_F(ProcedureTest, AConfirmationOfAnotherStepConfirmsNothing) {
  EXPECT_EQ(refusal("confirm", "approach"), "no step waits for its confirmation");
  procedure_.enter(2);
  EXPECT_EQ(refusal("confirm", "approach"),
            "the step that waits for its confirmation is 'insertion', not 'approach'");
  EXPECT_EQ(refusal("confirm"), "the step that waits for its confirmation is 'insertion', not ''");
  EXPECT_TRUE(procedure_.asks());
}

TEST_F(ProcedureTest, WhatIsPausedIsResumedFirst) {
  procedure_.enter_next();
  EXPECT_EQ(refusal("resume"), "it is not paused");
  EXPECT_EQ(refusal("pause"), "");
  EXPECT_TRUE(procedure_.paused());
  EXPECT_EQ(refusal("pause"), "it is paused already");
  EXPECT_EQ(refusal("confirm", "approach"), "it is paused: resume comes first");
  EXPECT_EQ(refusal("resume"), "");
  EXPECT_EQ(refusal("confirm", "approach"), "");
  EXPECT_EQ(refusal("pause"), "");
  EXPECT_FALSE(procedure_.may_act());
  EXPECT_EQ(refusal("abort"), "") << "always";
}

TEST_F(ProcedureTest, BackAtAStepThatAsksItAsksAgain) {
  procedure_.enter(1);
  EXPECT_EQ(refusal("confirm", "approach"), "");
  procedure_.enter(2);
  EXPECT_TRUE(procedure_.asks());
  EXPECT_EQ(refusal("back"), "");
  procedure_.turn_back();
  EXPECT_FALSE(procedure_.asks()) << "while it goes back";
  procedure_.enter(1);
  EXPECT_TRUE(procedure_.asks());
}

TEST_F(ProcedureTest, WhereNobodyIsAskedNothingWaits) {
  Procedure alone{steps(), true};
  alone.enter_next();
  EXPECT_FALSE(alone.asks());
  EXPECT_TRUE(alone.may_act());
  EXPECT_TRUE(alone.hear({.word = "pause"})) << "a word is heard all the same";
  EXPECT_FALSE(alone.may_act());
}

TEST_F(ProcedureTest, WhatIsOverHearsNothing) {
  procedure_.enter(2);
  procedure_.end(State::broken_off);
  EXPECT_EQ(procedure_.state_of(2), State::broken_off);
  EXPECT_FALSE(procedure_.asks());
  EXPECT_FALSE(procedure_.may_act());
  for (const char* word : {"confirm", "pause", "resume", "back", "abort"}) {
    EXPECT_EQ(refusal(word, "insertion"), "the procedure is over") << word;
  }
}

TEST_F(ProcedureTest, AWordThatIsNoneIsAnsweredWithThoseThatThereAre) {
  EXPECT_EQ(refusal("go"), "'go' is no command; there are confirm, pause, resume, back, abort");
}

TEST_F(ProcedureTest, StepsMayBecomeKnownOnTheWay) {
  procedure_.set_steps_ahead({{"site 1", true}, {"site 2", true}});
  ASSERT_EQ(procedure_.steps().size(), 3u);
  EXPECT_EQ(procedure_.steps()[0].name, "registration");
  EXPECT_EQ(procedure_.steps()[2].name, "site 2");
}

}  // namespace
}  // namespace armature
