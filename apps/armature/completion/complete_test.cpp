// SPDX-License-Identifier: Apache-2.0
#include "completion/complete.hpp"

#include <gmock/gmock.h>

namespace armature {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

VerbOption option(std::vector<std::string> names, int values,
                  std::vector<std::string> choices = {}) {
  return {.names = std::move(names), .values = values, .choices = std::move(choices)};
}

/// paint [-q,--quiet] (wall [--colour C] [--at X Y] kind | list)
Verb paint() {
  const Verb wall{.name = "wall",
                  .description = "Paint one",
                  .options = {option({"--colour"}, 1, {"red", "rose", "blue"}), option({"--at"}, 2),
                              option({"-q", "--quiet"}, 0)},
                  .positionals = {option({"kind"}, 1, {"brick", "wood"})}};
  const Verb list{.name = "list"};
  return {.name = "paint", .options = {option({"--version"}, 0)}, .verbs = {wall, list}};
}

std::vector<std::string> texts(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  for (const Candidate& one : complete(paint(), words)) all.push_back(one.text);
  return all;
}

TEST(Complete, OffersTheVerbsThatBeginAsTheWordDoes) {
  EXPECT_THAT(texts({""}), ElementsAre("wall", "list"));
  EXPECT_THAT(texts({}), ElementsAre("wall", "list"));
  EXPECT_THAT(texts({"w"}), ElementsAre("wall"));
  EXPECT_THAT(texts({"x"}), IsEmpty());
  EXPECT_THAT(complete(paint(), {"w"}), ElementsAre(Field(&Candidate::description, "Paint one")));
}

TEST(Complete, OffersTheOptionsOfTheVerbThatWasSaid) {
  EXPECT_THAT(texts({"-"}), ElementsAre("--version"));
  EXPECT_THAT(texts({"wall", "--"}), ElementsAre("--colour", "--at", "--quiet"));
  EXPECT_THAT(texts({"wall", "--c"}), ElementsAre("--colour"));
}

TEST(Complete, OffersTheValuesOfAnOptionThatWaitsForThem) {
  EXPECT_THAT(texts({"wall", "--colour", "r"}), ElementsAre("red", "rose"));
  EXPECT_THAT(texts({"wall", "--colour", "red", "w"}), ElementsAre("wood"));
  EXPECT_THAT(texts({"wall", "-q", "b"}), ElementsAre("brick"));
}

TEST(Complete, LeavesToTheShellWhatItDoesNotKnow) {
  EXPECT_THAT(texts({"wall", "--at", ""}), IsEmpty());
  EXPECT_THAT(texts({"wall", "--at", "1", ""}), IsEmpty());
  EXPECT_THAT(texts({"wall", "--at", "1", "2", ""}), ElementsAre("brick", "wood"));
}

TEST(Complete, HelpIsFollowedByAVerb) { EXPECT_THAT(texts({"help", "w"}), ElementsAre("wall")); }

}  // namespace
}  // namespace armature
