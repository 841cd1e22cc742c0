// SPDX-License-Identifier: Apache-2.0
#include "armature/config/reader.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "armature/config/document.hpp"
#include "tests/refusal.hpp"

namespace armature::config {
namespace {

std::string text_of(const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems.sorted()) text += problem.text() + "\n";
  return text;
}

using Type = KeySpec::Type;

/// What reading `yaml` as the number `key` says.
std::string number_problem(const std::string& yaml) {
  const Node node = parse_text("rate_hz: " + yaml, "f");
  Problems problems;
  MapReader{node, "scene", problems}.number("rate_hz");
  return text_of(problems);
}

TEST(Numbers, AreDecimal) {
  const auto number = [&](const char* text) {
    return to_number(parse_text(text, "f")).value_or(-999);
  };
  EXPECT_EQ(number("5"), 5);
  EXPECT_EQ(number("-0.5"), -0.5);
  EXPECT_EQ(number("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("0"), 0);
  EXPECT_EQ(number("0.45257"), 0.45257);
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
  EXPECT_EQ(to_integer(parse_text("-12", "f")).value(), -12);
  EXPECT_EQ(to_integer(parse_text("9223372036854775807", "f")).value(),
            std::numeric_limits<std::int64_t>::max());
  const auto refusal = [](const char* text) {
    const auto integer = to_integer(parse_text(text, "f"));
    return integer ? "none" : integer.error().message;
  };
  EXPECT_EQ(refusal("1.0"), "must be a whole number, not '1.0'");
  EXPECT_EQ(refusal("1e3"), "must be a whole number, not '1e3'");
  EXPECT_EQ(refusal("9223372036854775808"), "is '9223372036854775808', which 64 bits cannot hold");
}

TEST(Naturals, AreWholeFrom0ToAllOf64Bits) {
  const std::vector<KeySpec> table{
      {.name = "seed", .type = Type::integer, .fallback = default_value("7")}};
  const auto natural = [&](const std::string& text, Problems& problems) {
    const Node node = parse_text(text, "f");
    return MapReader{node, "the map", table, problems}.natural("seed");
  };
  Problems problems;
  EXPECT_EQ(natural("seed: 0", problems), 0U);
  EXPECT_EQ(natural("seed: 18446744073709551615", problems),
            std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(natural("{}", problems), 7U);
  EXPECT_TRUE(problems.empty());
  natural("seed: -1", problems);
  natural("seed: 18446744073709551616", problems);
  natural("seed: 1e3", problems);
  const std::string must =
      "f:1:7: 'seed' must be a whole number from 0 to 18446744073709551615, not ";
  EXPECT_EQ(text_of(problems),
            must + "'-1'\n" + must + "'18446744073709551616'\n" + must + "'1e3'\n");
}

TEST(Flags, AreTrueOrFalseOnly) {
  EXPECT_EQ(to_flag(parse_text("true", "f")).value(), true);
  EXPECT_EQ(to_flag(parse_text("false", "f")).value(), false);
  for (const char* word : {"yes", "off", "True", "1", "'true'", "[]"}) {
    EXPECT_FALSE(to_flag(parse_text(word, "f"))) << word;
  }
  EXPECT_EQ(to_flag(parse_text("yes", "f")).error().message, "must be true or false, not 'yes'");
}

TEST(Lists, NameTheItemThatIsWrong) {
  const Node node = parse_text("a: [1, 2]\nb: [1, x, 3]\nc: 5\n", "f");
  std::vector<KeySpec> table;
  for (const char* name : {"a", "b", "c", "d"}) {
    table.push_back({.name = name, .type = Type::numbers, .count = 3, .optional = true});
  }
  Problems problems;
  MapReader map{node, "joint", table, problems};
  for (const KeySpec& key : table) EXPECT_FALSE(map.optional_numbers(key.name)) << key.name;
  EXPECT_EQ(text_of(problems),
            "f:1:4: 'a' must be a list of 3 numbers, not of 2\n"
            "f:2:8: 'b' must be a list of 3 numbers; item 2 must be a number, not 'x'\n"
            "f:3:4: 'c' must be a list of 3 numbers, not '5'\n");
}

const std::vector<KeySpec>& slide() {
  static const std::vector<KeySpec> kTable{
      {.name = "d_m", .fallback = default_value("0"), .min = -1, .max = 1, .also = "d_mm"},
      {.name = "tilt_deg", .max = 90, .because = "it would fall", .above = 0},
      {.name = "limits_mm", .type = Type::numbers, .min = 0, .optional = true},
      {.name = "format", .type = Type::integer, .min = 1, .max = 1, .optional = true}};
  return kTable;
}

TEST(Tables, GiveValuesInSiUnitsByWhateverKeyTheyAreWritten) {
  Problems problems;
  const auto d = [&](const std::string& yaml) {
    const Node node = parse_text(yaml, "f");
    return MapReader{node, "slide", slide(), problems}.number("d_m");
  };
  EXPECT_EQ(d("d_m: 0.25"), 0.25);
  EXPECT_EQ(d("d_mm: 250"), 0.25);
  EXPECT_EQ(d("{}"), 0);
  const Node node = parse_text("{tilt_deg: 90, limits_mm: [0, 500]}", "f");
  MapReader map{node, "slide", slide(), problems};
  EXPECT_DOUBLE_EQ(map.number("tilt_deg"), std::numbers::pi / 2);
  EXPECT_EQ(map.optional_numbers("limits_mm"), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(map.optional_integer("format"), std::nullopt);
  EXPECT_TRUE(problems.empty()) << text_of(problems);
}

TEST(Tables, RefuseLengthsAndAnglesThatNoRobotHasUnlessTheyLimitThemThemselves) {
  const auto said = [](const std::string& yaml, std::optional<double> max = {}) {
    const std::vector<KeySpec> keys{{.name = "d_m", .max = max, .optional = true, .also = "d_mm"},
                                    {.name = "turn_deg", .optional = true},
                                    {.name = "at_mm", .type = Type::numbers, .optional = true}};
    Problems problems;
    const Node node = parse_text(yaml, "f");
    MapReader map{node, "slide", keys, problems};
    map.optional_number("d_m");
    map.optional_number("turn_deg");
    map.optional_numbers("at_mm");
    map.finish();
    return text_of(problems);
  };
  EXPECT_EQ(said("{d_m: 100, turn_deg: -1000000, at_mm: [100000, -100000]}"), "");
  EXPECT_EQ(said("{d_m: 120}"),
            "f:1:7: 'd_m' is 120, farther than 100 m; is it told in another unit?\n");
  EXPECT_EQ(said("{d_mm: -120000}"),
            "f:1:8: 'd_mm' is -120000, farther than 100 m; is it told in another unit?\n");
  EXPECT_EQ(said("{at_mm: [1, 1.0e+6]}"),
            "f:1:13: 'at_mm' item 2 is 1000000, farther than 100 m; is it told in another unit?\n");
  EXPECT_EQ(
      said("{turn_deg: 1000001}"),
      "f:1:12: 'turn_deg' is 1000001, more than 1e+06 degrees; is it told in another unit?\n");
  EXPECT_EQ(said("{d_m: 120}", 1000), "");
}

TEST(Tables, RefuseWhatIsOutOfRangeInTheUnitThatIsWritten) {
  Problems problems;
  const auto read = [&](const std::string& yaml) {
    const Node node = parse_text(yaml, yaml);
    MapReader map{node, "slide", slide(), problems};
    map.number("d_m");
    map.number("tilt_deg");
    map.optional_numbers("limits_mm");
    map.optional_integer("format");
    map.finish();
  };
  read("{tilt_deg: 1, d_mm: 1001}");
  read("{tilt_deg: 0, d_m: -2}");
  read("{tilt_deg: 1, d_m: 1, d_mm: 1}");
  read("{tilt_deg: 1, limits_mm: [1, -1]}");
  read("{tilt_deg: 1, format: 2}");
  read("{d_cm: 1}");
  EXPECT_EQ(text_of(problems),
            "{tilt_deg: 1, d_mm: 1001}:1:21: 'd_mm' is 1001, must be from -1000 to 1000\n"
            "{tilt_deg: 0, d_m: -2}:1:12: 'tilt_deg' is 0, must be more than 0 and at most 90: it "
            "would fall\n"
            "{tilt_deg: 0, d_m: -2}:1:20: 'd_m' is -2, must be from -1 to 1\n"
            "{tilt_deg: 1, d_m: 1, d_mm: 1}:1:29: 'd_m' and 'd_mm' state the same; keep one\n"
            "{tilt_deg: 1, limits_mm: [1, -1]}:1:30: 'limits_mm' item 2 is -1, must be at least "
            "0\n"
            "{tilt_deg: 1, format: 2}:1:23: 'format' is 2, must be 1\n"
            "{d_cm: 1}:1:1: missing key 'tilt_deg' in slide\n"
            "{d_cm: 1}:1:2: unknown key 'd_cm' in slide; did you mean 'd_m' or 'd_mm'?\n");
}

TEST(Tables, StandForAWrongValueWithTheirDefault) {
  const std::vector<KeySpec> table{
      {.name = "executor", .type = Type::text, .fallback = default_value("main")}};
  const Node node = parse_text("{executor: [a]}", "f");
  Problems problems;
  MapReader map{node, "component", table, problems};
  EXPECT_EQ(map.text("executor"), "main");
  EXPECT_EQ(text_of(problems), "f:1:12: 'executor' must be a text, not a list\n");
}

TEST(Tables, AreWhatReadingAsksFor) {
  const Node node = parse_text("{tilt_deg: 1}", "f");
  const auto defect = [&](auto ask) -> std::string {
    Problems problems;
    MapReader map{node, "slide", slide(), problems};
    return test::refusal_of([&] { ask(map); });
  };
  EXPECT_EQ(defect([](MapReader& map) { map.number("tilt"); }),
            "the table of slide has no key 'tilt'");
  EXPECT_EQ(defect([](MapReader& map) { map.flag("tilt_deg"); }),
            "key 'tilt_deg' of slide is asked for as another type");
  EXPECT_EQ(defect([](MapReader& map) {
              map.number("tilt_deg");
              map.finish();
            }),
            "key 'd_m' of slide is in the table and never read");
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
