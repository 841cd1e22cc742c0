// SPDX-License-Identifier: Apache-2.0
#include "armature/task/heard_word.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

constexpr Time kNoon{43'200'000'000'000};

std::string refusal_at(const std::string& word, Time stamp) {
  const auto may = in_time(word, stamp, kNoon);
  return may ? "" : may.error().text;
}

TEST(HeardWord, ThatMovesTheArmHoldsForASecond) {
  for (const std::string word : {"confirm", "resume", "back"}) {
    EXPECT_EQ(refusal_at(word, kNoon), "");
    EXPECT_EQ(refusal_at(word, kNoon - seconds(1)), "");
    EXPECT_EQ(refusal_at(word, kNoon + seconds(1)), "");
    EXPECT_NE(refusal_at(word, kNoon - seconds(1.001)), "");
    EXPECT_NE(refusal_at(word, kNoon + seconds(1.001)), "");
  }
}

TEST(HeardWord, IsRefusedWithItsAgeAndTheWayOut) {
  EXPECT_EQ(refusal_at("confirm", kNoon - seconds(100)),
            "'confirm' was said 100.0 s ago, and holds for 1 s: say it again; when it is new, the "
            "clock of its host is behind");
  EXPECT_EQ(refusal_at("resume", kNoon + seconds(100)),
            "'resume' is stamped 100.0 s ahead of now, and 1 s are allowed: set the clock of its "
            "host");
  EXPECT_EQ(refusal_at("back", Time{}),
            "'back' has no time, so that it may be an old one: say it with armature operator, or "
            "write the time of now to header.stamp");
}

TEST(HeardWord, ThatMakesSafeIsInTimeWhateverItsStamp) {
  for (const std::string word : {"pause", "abort"}) {
    for (const Time stamp : {Time{}, kNoon - seconds(86400), kNoon + seconds(86400)}) {
      EXPECT_EQ(refusal_at(word, stamp), "") << word;
    }
  }
  EXPECT_EQ(refusal_at("shutdown", Time{}), "") << "it is no word, which is said elsewhere";
}

TEST(HeardWord, IsCutBehindSixtyFourLetters) {
  msg::OperatorCommand message;
  message.command_id_(7);
  message.command_() = std::string(10'000'000, 'x');
  std::string umlauts;
  for (int i = 0; i < 65; ++i) umlauts += "\u00e4";
  message.step_() = umlauts;
  const OperatorCommand heard = heard_word(message);
  EXPECT_EQ(heard.id, 7U);
  EXPECT_EQ(heard.word, std::string(64, 'x') + "...");
  EXPECT_EQ(heard.step, umlauts.substr(0, 128) + "...") << "letters, no bytes";
  message.step_() = umlauts.substr(2);
  EXPECT_EQ(heard_word(message).step, umlauts.substr(2)) << "64 are not cut";
}

}  // namespace
}  // namespace armature
