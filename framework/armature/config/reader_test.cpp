// SPDX-License-Identifier: Apache-2.0
#include "armature/config/reader.hpp"

#include <gtest/gtest.h>

#include "armature/config/document.hpp"

namespace armature::config {
namespace {

std::string text_of(const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems.sorted()) text += problem.text() + "\n";
  return text;
}

/// What reading `yaml` as the number `key` says.
std::string number_problem(const std::string& yaml) {
  const Node node = parse_text("rate_hz: " + yaml, "f");
  Problems problems;
  MapReader{node, "scene", problems}.number("rate_hz");
  return text_of(problems);
}

TEST(Numbers, AreDecimal) {
  Problems problems;
  const auto number = [&](const char* text) {
    return as_number(parse_text(text, "f"), problems).value_or(-999);
  };
  EXPECT_EQ(number("5"), 5);
  EXPECT_EQ(number("-0.5"), -0.5);
  EXPECT_EQ(number("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("0"), 0);
  EXPECT_EQ(number("0.45257"), 0.45257);
  EXPECT_TRUE(problems.empty()) << text_of(problems);
}

TEST(Numbers, ThatAreNoneTellTheWayOut) {
  EXPECT_EQ(number_problem("fast"), "f:1:10: 'rate_hz' must be a number, not 'fast'\n");
  EXPECT_EQ(number_problem("'5'"),
            "f:1:10: 'rate_hz' must be a number, not the text '5'; write it without quotes\n");
  EXPECT_EQ(number_problem("010"),
            "f:1:10: 'rate_hz' must be a number, and '010' is octal to some readers; write 10\n");
  EXPECT_EQ(number_problem("-00.5"),
            "f:1:10: 'rate_hz' must be a number, and '-00.5' is octal to some readers; write "
            "-0.5\n");
  EXPECT_EQ(number_problem("1_000"),
            "f:1:10: 'rate_hz' must be a number, not '1_000'; write 1000\n");
  EXPECT_EQ(number_problem("-0x10"),
            "f:1:10: 'rate_hz' must be a number, not '-0x10'; write -16\n");
  EXPECT_EQ(number_problem(".nan"),
            "f:1:10: 'rate_hz' must be a number, not '.nan'; it must be finite\n");
  EXPECT_EQ(number_problem("-.inf"),
            "f:1:10: 'rate_hz' must be a number, not '-.inf'; it must be finite\n");
  EXPECT_EQ(number_problem("0,5"), "f:1:10: 'rate_hz' must be a number, not '0,5'; write 0.5\n");
  EXPECT_EQ(number_problem("-30 deg"),
            "f:1:10: 'rate_hz' must be a number, not '-30 deg'; write -30 alone: the unit is part "
            "of the key's name\n");
  EXPECT_EQ(number_problem("1e999"), "f:1:10: 'rate_hz' is '1e999', which a double cannot hold\n");
  EXPECT_EQ(number_problem("[1]"), "f:1:10: 'rate_hz' must be a number, not a list\n");
  EXPECT_EQ(number_problem(""), "f:1:1: 'rate_hz' must be a number, not nothing\n");
  EXPECT_EQ(number_problem("off"), "f:1:10: 'rate_hz' must be a number, not 'off'\n");
}

TEST(Integers, AreWhole) {
  Problems problems;
  EXPECT_EQ(as_integer(parse_text("-12", "f"), problems), -12);
  EXPECT_EQ(as_integer(parse_text("9223372036854775807", "f"), problems),
            std::numeric_limits<std::int64_t>::max());
  EXPECT_TRUE(problems.empty());
  EXPECT_FALSE(as_integer(parse_text("1.0", "f"), problems));
  EXPECT_FALSE(as_integer(parse_text("1e3", "f"), problems));
  EXPECT_FALSE(as_integer(parse_text("9223372036854775808", "f"), problems));
  EXPECT_EQ(text_of(problems),
            "f:1:1: must be a whole number, not '1.0'\n"
            "f:1:1: must be a whole number, not '1e3'\n"
            "f:1:1: is '9223372036854775808', which 64 bits cannot hold\n");
}

TEST(Naturals, AreWholeFrom0ToAllOf64Bits) {
  const auto natural = [](const std::string& text, Problems& problems) {
    const Node node = parse_text("seed: " + text, "f");
    return MapReader{node, "the map", problems}.natural("seed", 7);
  };
  Problems problems;
  EXPECT_EQ(natural("0", problems), 0U);
  EXPECT_EQ(natural("18446744073709551615", problems), std::numeric_limits<std::uint64_t>::max());
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(natural("-1", problems), 7U);
  EXPECT_EQ(natural("18446744073709551616", problems), 7U);
  EXPECT_EQ(natural("1e3", problems), 7U);
  const std::string must =
      "f:1:7: 'seed' must be a whole number from 0 to 18446744073709551615, not ";
  EXPECT_EQ(text_of(problems),
            must + "'-1'\n" + must + "'18446744073709551616'\n" + must + "'1e3'\n");
}

TEST(Flags, AreTrueOrFalseOnly) {
  Problems problems;
  EXPECT_EQ(as_flag(parse_text("true", "f"), problems), true);
  EXPECT_EQ(as_flag(parse_text("false", "f"), problems), false);
  EXPECT_TRUE(problems.empty());
  for (const char* word : {"yes", "off", "True", "1", "'true'", "[]"}) {
    EXPECT_FALSE(as_flag(parse_text(word, "f"), problems)) << word;
  }
  EXPECT_EQ(problems.sorted().front().text(), "f:1:1: must be true or false, not 'yes'");
}

TEST(Lists, NameTheItemThatIsWrong) {
  const Node node = parse_text("a: [1, 2]\nb: [1, x, 3]\nc: 5\n", "f");
  Problems problems;
  MapReader map{node, "joint", problems};
  EXPECT_EQ(map.numbers("a", 3), (std::vector<double>{0, 0, 0}));
  map.numbers("b", 3);
  map.numbers("c", 3);
  EXPECT_FALSE(map.optional_numbers("d", 3));
  EXPECT_EQ(text_of(problems),
            "f:1:4: 'a' must be a list of 3 numbers, not of 2\n"
            "f:2:8: 'b' must be a list of 3 numbers; item 2 must be a number, not 'x'\n"
            "f:3:4: 'c' must be a list of 3 numbers, not '5'\n");
}

TEST(MapReading, CollectsEveryProblemAndGoesOn) {
  const Node node = parse_text("plugn: ik/x\nrate_hz: fast\nreads: lates\nextra: 1\n", "f");
  Problems problems;
  MapReader map{node, "component 'arm'", problems};
  EXPECT_EQ(map.text("plugin"), "");
  EXPECT_EQ(map.number("rate_hz", 7.0), 7.0);
  EXPECT_EQ(map.choice("reads", {"latest", "queue"}, "queue"), "queue");
  EXPECT_EQ(map.flag("missing", true), true);
  map.problem("reads", "noted at the value");
  map.problem("absent", "noted at the map");
  map.finish();
  EXPECT_EQ(
      text_of(problems),
      "f:1:1: missing key 'plugin' in component 'arm'\n"
      "f:1:1: noted at the map\n"
      "f:1:1: unknown key 'plugn' in component 'arm'; did you mean 'plugin'?\n"
      "f:2:10: 'rate_hz' must be a number, not 'fast'\n"
      "f:3:8: 'reads' cannot be 'lates'; did you mean 'latest'?\n"
      "f:3:8: noted at the value\n"
      "f:4:1: unknown key 'extra' in component 'arm'; known: absent, missing, plugin, rate_hz, "
      "reads\n");
}

TEST(MapReading, OfSomethingElseIsOneProblem) {
  const Node node = parse_text("[1]", "f");
  Problems problems;
  MapReader map{node, "joint", problems};
  map.text("name");
  map.finish();
  EXPECT_EQ(text_of(problems), "f:1:1: joint must be a map, not a list\n");
}

}  // namespace
}  // namespace armature::config
