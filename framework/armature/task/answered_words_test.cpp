// SPDX-License-Identifier: Apache-2.0
#include "armature/task/answered_words.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

constexpr Time from_start(double s) { return Time{} + seconds(s); }

class AnsweredWordsTest : public testing::Test {
 protected:
  /// Whether the word is obeyed, or would be: it is not one that is told again.
  bool is_new(std::uint64_t id, const std::string& word, double s, const std::string& why = "") {
    const OperatorCommand command{.id = id, .word = word};
    if (words_.knows(command, from_start(s))) return false;
    words_.add(command, why.empty() ? Expected<void>{} : refuse(why), from_start(s));
    return true;
  }
  void expect_told(std::uint64_t id, const std::string& text) {
    EXPECT_EQ(words_.next(), (AnsweredWords::Answer{id, text}));
  }

  AnsweredWords words_;
};

TEST_F(AnsweredWordsTest, AResumeThatIsToldAgainBehindAnothersPauseIsAnsweredAndNotObeyed) {
  EXPECT_TRUE(is_new(7, "resume", 0));
  EXPECT_TRUE(is_new(9, "pause", 0));
  expect_told(7, "");
  expect_told(9, "");
  EXPECT_FALSE(words_.waits());
  EXPECT_FALSE(is_new(7, "resume", 0.1));
  EXPECT_FALSE(is_new(9, "pause", 0.1));
  EXPECT_FALSE(is_new(7, "resume", 60)) << "however late";
  expect_told(7, "");
  expect_told(9, "");
  EXPECT_FALSE(words_.waits()) << "each once";
}

TEST_F(AnsweredWordsTest, TheAnswerThatWasToldLastStands) {
  expect_told(0, "");
  EXPECT_TRUE(is_new(7, "back", 0, "there is no step before this one"));
  expect_told(7, "there is no step before this one");
  expect_told(7, "there is no step before this one");
}

TEST_F(AnsweredWordsTest, TheFirstWordMayHaveAnyNumber) {
  EXPECT_TRUE(is_new(0, "abort", 0));
  EXPECT_TRUE(words_.waits());
  EXPECT_FALSE(is_new(0, "abort", 0.1));
}

TEST_F(AnsweredWordsTest, AnotherWordUnderTheSameNumberIsNew) {
  EXPECT_TRUE(is_new(0, "pause", 0));
  EXPECT_TRUE(is_new(0, "abort", 0));
}

TEST_F(AnsweredWordsTest, APauseIsNewOnceAnotherWordWasObeyed) {
  EXPECT_TRUE(is_new(0, "pause", 0));
  EXPECT_TRUE(is_new(0, "resume", 0.1, "it moves on"));
  EXPECT_FALSE(is_new(0, "pause", 0.1)) << "the other one was refused";
  EXPECT_TRUE(is_new(1, "resume", 0.2));
  EXPECT_TRUE(is_new(0, "pause", 0.3));
}

TEST_F(AnsweredWordsTest, AnAbortIsNewOnceNobodyHasToldItForASecond) {
  EXPECT_TRUE(is_new(0, "abort", 0, "the arm is stopped: rearm it first"));
  EXPECT_FALSE(is_new(0, "abort", 0.9));
  EXPECT_FALSE(is_new(0, "abort", 1.8)) << "it is told again all the time";
  EXPECT_TRUE(is_new(0, "abort", 2.9));
}

TEST_F(AnsweredWordsTest, SixtyFourAreRemembered) {
  for (std::uint64_t id = 0; id < 64; ++id) EXPECT_TRUE(is_new(id, "resume", 0));
  EXPECT_FALSE(is_new(0, "resume", 1));
  EXPECT_TRUE(is_new(64, "resume", 1));
  EXPECT_TRUE(is_new(0, "resume", 1)) << "the oldest is forgotten";
}

}  // namespace
}  // namespace armature
