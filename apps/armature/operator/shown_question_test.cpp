// SPDX-License-Identifier: Apache-2.0
#include "operator/shown_question.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using std::chrono::milliseconds;

class ShownQuestionTest : public testing::Test {
 protected:
  ShownQuestion question_;
  const ShownQuestion::Moment start_ = ShownQuestion::Moment{} + std::chrono::hours{1};
};

TEST_F(ShownQuestionTest, WhereNoneWasShownNoStepIsMeant) {
  EXPECT_EQ(question_.confirmed(start_).value(), "");
}

TEST_F(ShownQuestionTest, TheFirstOneIsAnsweredAtOnce) {
  question_.show("alignment", start_);
  EXPECT_EQ(question_.confirmed(start_).value(), "alignment");
}

TEST_F(ShownQuestionTest, OneThatHasJustTakenAnothersPlaceIsNotAnswered) {
  question_.show("alignment", start_);
  const auto changed = start_ + milliseconds{3000};
  question_.show("search", changed);
  const auto early = question_.confirmed(changed + milliseconds{499});
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().text,
            "the question has just changed from 'alignment' to 'search', and nothing is "
            "confirmed: say it again");
  EXPECT_EQ(question_.confirmed(changed + milliseconds{500}).value(), "search");
}

TEST_F(ShownQuestionTest, ATimeWithoutOneInBetweenDoesNotCountAsReading) {
  question_.show("alignment", start_);
  question_.show("", start_ + milliseconds{100});
  const auto came_up = start_ + milliseconds{4000};
  question_.show("search", came_up);
  EXPECT_FALSE(question_.confirmed(came_up + milliseconds{499}));
  EXPECT_EQ(question_.confirmed(came_up + milliseconds{500}).value(), "search");
}

TEST_F(ShownQuestionTest, TheSameStepThatAsksAgainIsAnsweredAtOnce) {
  question_.show("alignment", start_);
  question_.show("", start_ + milliseconds{100});
  question_.show("alignment", start_ + milliseconds{120});
  EXPECT_EQ(question_.confirmed(start_ + milliseconds{120}).value(), "alignment");
}

}  // namespace
}  // namespace armature
