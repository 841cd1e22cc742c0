// SPDX-License-Identifier: Apache-2.0
#include "armature/config/problems.hpp"

#include <gtest/gtest.h>

namespace armature::config {
namespace {

std::string hint(std::string_view wrong, std::vector<std::string> known) {
  return did_you_mean(wrong, known);
}

TEST(DidYouMean, NamesTheNearestByEditDistance) {
  EXPECT_EQ(hint("plugn", {"params", "plugin", "executor"}), "; did you mean 'plugin'?");
  EXPECT_EQ(hint("plguin", {"plugin", "plug"}), "; did you mean 'plugin'?") << "a swap counts once";
  EXPECT_EQ(hint("PLUGIN", {"plugin"}), "; did you mean 'plugin'?");
  EXPECT_EQ(hint("left", {"lift", "loft", "right"}), "; did you mean 'lift' or 'loft'?");
}

TEST(DidYouMean, KnowsUnitSuffixesAndFamilies) {
  EXPECT_EQ(hint("distance_mm", {"distances", "distance_m"}), "; did you mean 'distance_m'?");
  EXPECT_EQ(hint("rate", {"rate_hz", "gate"}), "; did you mean 'rate_hz'?");
  EXPECT_EQ(hint("numeric", {"ik/numeric", "path/arc"}), "; did you mean 'ik/numeric'?");
  EXPECT_EQ(hint("ik/lamp", {"ik/numeric", "ik/lamp_geometric"}),
            "; did you mean 'ik/lamp_geometric'?");
}

TEST(DidYouMean, ListsAtMostEightKnownNamesWhenNoneIsNear) {
  EXPECT_EQ(hint("zebra", {"a", "b"}), "; known: a, b");
  EXPECT_EQ(hint("x", {"y"}), "; known: y") << "one letter is no likeness";
  EXPECT_EQ(hint("zebra", {"a", "b", "c", "d", "e", "f", "g", "h", "i"}),
            "; known: a, b, c, d, e, f, g, h, ...");
  EXPECT_EQ(hint("zebra", {}), "");
  EXPECT_EQ(hint(std::string(100'000, 'x'), {"a"}), "; known: a");
}

TEST(Problems, AreSortedByFileAsMetThenPlaceAndToldOnce) {
  Problems problems;
  problems.add({"b.yaml", 9, 1}, "third");
  problems.add({"a.yaml", 1, 1}, "fourth");
  problems.add({"b.yaml", 2, 7}, "second");
  problems.add({"b.yaml", 2, 3}, "first");
  problems.add({"b.yaml", 9, 1}, "third");
  try {
    problems.throw_if_any();
    FAIL() << "did not throw";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "b.yaml:2:3: first\nb.yaml:2:7: second\nb.yaml:9:1: third\na.yaml:1:1: fourth");
    EXPECT_EQ(error.problems().size(), 4U);
  }
}

TEST(Problems, WithoutAPlaceAreTheirMessage) {
  EXPECT_EQ((Problem{{}, "message"}.text()), "message");
  EXPECT_EQ((Problem{{"--set a=b", 0, 0}, "message"}.text()), "--set a=b: message");
}

TEST(Problems, ThrowNothingWhenThereIsNone) { EXPECT_NO_THROW(Problems{}.throw_if_any()); }

TEST(InQuotes, KeepsMessagesOnOneShortLine) {
  EXPECT_EQ(in_quotes("a\nb\x01"), "'a\\nb\\x01'");
  EXPECT_EQ(in_quotes(std::string(70, 'x')), "'" + std::string(60, 'x') + "...'");
  EXPECT_EQ(in_quotes("é"), "'é'");
}

}  // namespace
}  // namespace armature::config
