// SPDX-License-Identifier: Apache-2.0
// SR-1 without a tracker: the arm is led by hand from marker to marker, and the biopsy goes on from
// what its tip touched; and what a hand may do wrong. An elbow in the way, too.
#include <gmock/gmock.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

using testing::HasSubstr, testing::Not;

DeploymentRun touching(std::vector<std::string> settings = {}) {
  return run_deployment(
      {.files = {source_file("configs/sr1_touching.yaml")}, .settings = std::move(settings)});
}

const std::string kHand = "components.hand.params.", kTask = "components.task.params.";

void expect_touched_and_inserted(const DeploymentRun& run) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 0);
  EXPECT_EQ(run.status(), "ok");
  EXPECT_THAT(run.command.err, HasSubstr("6 of 6 markers touched"));
  EXPECT_LE(run.figure("target_error_of_bound_999"), 1);
  EXPECT_LE(run.figure("line_deviation_mm"), 0.01);
}

TEST(Sr1Touching, ComesToTheTargetTwiceInTheSameWay) {
  const DeploymentRun first = touching(), second = touching();
  expect_touched_and_inserted(first);
  EXPECT_EQ(first.report, second.report);
  EXPECT_GT(first.figure("touch_error_mm"), 0.2) << "the hand misses by 0.5 mm rms";
  EXPECT_LT(first.figure("touch_error_mm"), 0.9);
}

/// Tremor is averaged over the rest, and what is left is rounding.
TEST(Sr1Touching, AHandThatMissesByNothingTouchesTheMarkersThemselves) {
  const DeploymentRun run = touching({kHand + "touch_error_mm=0"});
  expect_touched_and_inserted(run);
  EXPECT_LT(run.figure("touch_error_mm"), 0.02);
  EXPECT_LT(run.figure("target_error_mm"), 0.02);
}

TEST(Sr1Touching, AnyOrderDoes) {
  expect_touched_and_inserted(touching({kHand + "order=[6, 2, 4, 1, 5, 3]"}));
}

TEST(Sr1Touching, TheSameMarkerTwiceIsNotTakenTwice) {
  const DeploymentRun run = touching({kHand + "order=[1, 1, 2, 3, 4, 5, 6]"});
  expect_touched_and_inserted(run);
  EXPECT_THAT(run.command.err, HasSubstr("this is touch 1 again"));
}

/// It ends by itself, with the reason; no needle has gone towards the head.
void expect_refused(std::vector<std::string> settings, const std::string& reason) {
  settings.push_back(kTask + "touch_timeout_s=10");
  const DeploymentRun run = touching(settings);
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.status(), "refused");
  EXPECT_THAT(run.command.err, HasSubstr("refused: " + reason));
  EXPECT_FALSE(run.tells("line_deviation_mm"));
}

TEST(Sr1Touching, FewerMarkersThanThePlanHasAreRefused) {
  expect_refused({kHand + "order=[1, 2, 3, 4]"}, "marker 5 of 6 was not touched for 10 s");
}

/// Between two markers: the arm hangs there, and its tip rests.
TEST(Sr1Touching, AHandThatLetsGoHalfWayIsNoTouch) {
  const DeploymentRun run = touching(
      {kHand + "order=[1, 3, 5, 2, 4, 6]", kHand + "lets_go_s=12", kTask + "touch_timeout_s=10"});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "refused");
  EXPECT_THAT(run.command.err, HasSubstr("2 of 6 markers touched"));
  EXPECT_THAT(run.command.err, Not(HasSubstr("3 of 6 markers touched")));
  EXPECT_THAT(run.word("reason"), HasSubstr("and no two markers of the plan are: "));
}

TEST(Sr1Touching, ATipThatMovesIsNoTouch) {
  expect_refused({kHand + "tremor_mm=2"}, "marker 1 of 6 was not touched for 10 s");
}

TEST(Sr1Touching, TouchesThatMissByMoreThanIsStatedAreRefused) {
  const DeploymentRun run = touching({kHand + "touch_error_mm=8"});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "refused");
}

/// The zone is far from the needle's line, but not from the arm that holds it.
TEST(Sr1Links, AnElbowThatWouldPassThroughAZoneIsNamed) {
  const DeploymentRun run = run_deployment(
      {.files = {source_file("configs/sr1_biopsy.yaml")},
       .settings = {"components.head.params.vessels_mm=[29, 146, 160, 29, 146, 160, 20]"}});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "refused");
  EXPECT_THAT(run.command.err, HasSubstr("refused: links: link 'forearm' comes nearer than 1 mm"));
}

}  // namespace
}  // namespace armature::test
