// SPDX-License-Identifier: Apache-2.0
#include "sweep/variations.hpp"

#include <gmock/gmock.h>

#include "tests/refusal.hpp"

namespace armature::sweep {
namespace {

using test::refusal_of;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Seeds, AreRangesAndNumbersInTheirOrder) {
  EXPECT_THAT(seeds_of("3"), ElementsAre(3u));
  EXPECT_THAT(seeds_of("9,1..4,7"), ElementsAre(9u, 1u, 2u, 3u, 4u, 7u));
  EXPECT_THAT(seeds_of("18446744073709551614..18446744073709551615"),
              ElementsAre(18446744073709551614u, 18446744073709551615u));
}

TEST(Seeds, ThatAreNoneAreRefusedWithTheReason) {
  EXPECT_THAT(refusal_of([] { seeds_of("1...4"); }), HasSubstr("'.4' is no seed"));
  EXPECT_THAT(refusal_of([] { seeds_of(""); }), HasSubstr("'' is no seed"));
  EXPECT_THAT(refusal_of([] { seeds_of("-1"); }), HasSubstr("'-1' is no seed"));
  EXPECT_THAT(refusal_of([] { seeds_of("5..3"); }), HasSubstr("'5..3' goes down"));
  EXPECT_THAT(refusal_of([] { seeds_of("1..3,2"); }), HasSubstr("seed 2 is there twice"));
  EXPECT_THAT(refusal_of([] { seeds_of("0..1000000"); }), HasSubstr("more than 1000000"));
}

TEST(Variations, AreEveryCombinationAndALastKeyThatChangesFastest) {
  EXPECT_THAT(combinations({}), ElementsAre(testing::IsEmpty()));
  EXPECT_THAT(combinations({vary_of("a=1,2"), vary_of("b.c=[x,y],z")}),
              ElementsAre(ElementsAre("a=1", "b.c=[x,y]"), ElementsAre("a=1", "b.c=z"),
                          ElementsAre("a=2", "b.c=[x,y]"), ElementsAre("a=2", "b.c=z")));
}

TEST(AssignmentsOfASweep, AreNotOfWhatItSetsItself) {
  EXPECT_THAT(refusal_of([] { check_assignment("seed=7"); }),
              HasSubstr("'seed=7': a sweep sets the seed itself; say which with --seeds 7"));
  EXPECT_THAT(refusal_of([] { check_assignment("clock = system"); }),
              HasSubstr("a sweep runs in lockstep on the simulated clock; leave it out"));
  EXPECT_EQ(refusal_of([] { check_assignment("clock=simulated"); }), "");
  EXPECT_EQ(refusal_of([] { check_assignment("components.head.params.seeds=1"); }), "");
}

TEST(Variations, ThatAreNoneAreRefused) {
  EXPECT_THAT(refusal_of([] { vary_of("a"); }), HasSubstr("'a' is not key=a,b,c"));
  EXPECT_THAT(refusal_of([] { vary_of("=1"); }), HasSubstr("is not key=a,b,c"));
  EXPECT_THAT(refusal_of([] { vary_of("a=1,1"); }), HasSubstr("a value twice"));
  EXPECT_THAT(refusal_of([] { vary_of("seed=1,2"); }), HasSubstr("sets 'seed' itself"));
  EXPECT_THAT(refusal_of([] {
                combinations({vary_of("a=1"), vary_of("a=2")});
              }),
              HasSubstr("'a' is varied twice"));
}

}  // namespace
}  // namespace armature::sweep
