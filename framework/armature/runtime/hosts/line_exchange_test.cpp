// SPDX-License-Identifier: Apache-2.0
// Lines arrive once and in order, whatever becomes of the messages that carry them.
#include "armature/runtime/hosts/line_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "armature/values/utf8.hpp"

namespace armature {
namespace {

std::vector<std::string> received(LineExchange& end) {
  std::vector<std::string> lines;
  while (auto line = end.receive()) lines.push_back(std::move(*line));
  return lines;
}

TEST(LineExchange, BeginsWithWhoeverAnswers) {
  LineExchange asks{"desk"}, answers{"main"};
  asks.send("here");
  EXPECT_TRUE(answers.take(asks.message(), Time{1}));
  EXPECT_EQ(answers.other(), "desk");
  EXPECT_EQ(received(answers), std::vector<std::string>{"here"});
  EXPECT_TRUE(asks.take(answers.message(), Time{2}));
  EXPECT_EQ(asks.other(), "main");
  EXPECT_EQ(asks.waiting(), 0U);
  EXPECT_EQ(asks.heard(), Time{2});
}

TEST(LineExchange, TakesNothingOfAThird) {
  LineExchange desk{"desk"}, main{"main"}, third{"third"};
  main.take(desk.message(), Time{1});
  desk.take(main.message(), Time{1});
  third.send("stop");
  EXPECT_FALSE(main.is_asked_by_third());
  EXPECT_FALSE(main.take(third.message(), Time{2})) << "it asks for anybody";
  EXPECT_TRUE(main.is_asked_by_third());
  EXPECT_FALSE(main.take("main third 0 1\nstop", Time{2}));
  EXPECT_FALSE(main.take("else desk 0 1\nstop", Time{2}));
  EXPECT_FALSE(main.receive());
  EXPECT_EQ(main.heard(), Time{1});
}

TEST(LineExchange, NeverHearsAgainWhomItHasTurnedAway) {
  LineExchange stranger{"stranger"}, desk{"desk"}, main{"main"};
  stranger.send("here");
  EXPECT_TRUE(main.take(stranger.message(), Time{1}));
  main.send("go");
  EXPECT_TRUE(stranger.take(main.message(), Time{1}));
  main.turn_away();
  EXPECT_EQ(main.other(), "");
  EXPECT_FALSE(main.take(stranger.message(), Time{2}));
  EXPECT_FALSE(main.receive());
  desk.send("here");
  EXPECT_TRUE(main.take(desk.message(), Time{3}));
  EXPECT_EQ(received(main), std::vector<std::string>{"here"});
  EXPECT_TRUE(desk.take(main.message(), Time{3}));
  EXPECT_FALSE(desk.receive()) << "what the stranger was told";
}

TEST(LineExchange, TakesNoMessageThatIsNone) {
  LineExchange main{"main"};
  for (const char* text : {"", "\n", "main", "main desk", "main desk 0", "main desk x 1",
                           "main desk 0 -1", "main desk 0 1x", "main  0 1", "main desk 7 1"}) {
    EXPECT_FALSE(main.take(text, Time{1})) << text;
  }
  EXPECT_FALSE(main.receive());
}

TEST(LineExchange, GoesOnAfterALineWithLineEndsAndAnEmptyOne) {
  LineExchange desk{"desk"}, main{"main"};
  desk.send("stop face: step failed:\nno face\n");
  desk.send("");
  EXPECT_TRUE(main.take(desk.message(), Time{1}));
  EXPECT_TRUE(desk.take(main.message(), Time{2})) << "as many lines were taken as were sent";
  EXPECT_EQ(desk.waiting(), 0U);
  desk.send("end");
  EXPECT_TRUE(main.take(desk.message(), Time{3}));
  EXPECT_EQ(received(main),
            (std::vector<std::string>{"stop face: step failed: no face ", " ", "end"}));
}

TEST(LineExchange, CutsALongLineAndGoesOnBehindIt) {
  LineExchange desk{"desk"}, main{"main"};
  desk.send("stop " + std::string(40'000, 'x'));
  desk.send("end");
  for (int messages = 1; messages <= 2; ++messages) {
    EXPECT_TRUE(main.take(desk.message(), Time{messages}));
    EXPECT_TRUE(desk.take(main.message(), Time{messages}));
  }
  EXPECT_EQ(received(main),
            (std::vector<std::string>{"stop " + std::string(8'000 - 5 - 3, 'x') + "...", "end"}));
  EXPECT_EQ(desk.waiting(), 0U);
}

TEST(LineExchange, CutsNoCharacterInTwo) {
  LineExchange desk{"desk"}, main{"main"};
  std::string umlauts;
  for (int i = 0; i < 5000; ++i) umlauts += "\u00fc";
  for (const std::string begin : {"stop ", "stop it "}) {
    desk.send(begin + umlauts);
    EXPECT_TRUE(main.take(desk.message(), Time{1}));
    EXPECT_TRUE(desk.take(main.message(), Time{1}));
    const auto lines = received(main);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(is_utf8(lines[0]));
    EXPECT_GE(lines[0].size(), 7'999U);
  }
}

TEST(LineExchange, CarriesEveryLineOnceAndInOrderOverAWayThatLosesDoublesAndReorders) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random{seed};
  const auto chance = [&](double share) { return std::bernoulli_distribution{share}(random); };
  LineExchange ends[2]{LineExchange{"left"}, LineExchange{"right"}};
  std::vector<std::string> sent[2], got[2];
  std::vector<std::pair<int, std::string>> on_the_way;  // to whom
  for (int step = 0; step < 3000; ++step) {
    const int from = static_cast<int>(random() % 2);
    if (step < 2000 && chance(0.5)) {
      sent[from].push_back("line " + std::to_string(sent[from].size()) +
                           std::string(random() % 300, 'x'));
      ends[from].send(sent[from].back());
    }
    const std::string message = ends[from].message();
    for (int copies = chance(0.4) ? 0 : chance(0.2) ? 2 : 1; copies > 0; --copies) {
      on_the_way.emplace_back(1 - from, message);
    }
    std::ranges::shuffle(on_the_way, random);
    for (std::size_t left = on_the_way.size() > 5 ? 5 : 0; on_the_way.size() > left;) {
      const auto [to, text] = on_the_way.back();
      on_the_way.pop_back();
      ends[to].take(text, Time{step});
    }
    for (int end : {0, 1}) {
      for (auto& line : received(ends[end])) got[end].push_back(std::move(line));
    }
  }
  EXPECT_GT(sent[0].size(), 300U);
  EXPECT_EQ(got[1], sent[0]);
  EXPECT_EQ(got[0], sent[1]);
  EXPECT_EQ(ends[0].waiting(), 0U);
}

}  // namespace
}  // namespace armature
