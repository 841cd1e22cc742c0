// SPDX-License-Identifier: Apache-2.0
// SR-1: from unordered markers to a needle at its target, by one file; and every way in which it
// must not go on.
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

DeploymentRun biopsy(std::vector<std::string> settings = {}) {
  return run_deployment(
      {.files = {source_file("configs/sr1_biopsy.yaml")}, .settings = std::move(settings)});
}

const std::string kSixTurningJoints = "robots.arm=" + source_file("configs/robots/sr1.yaml");

void expect_inserted(const DeploymentRun& run) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 0);
  EXPECT_EQ(run.status(), "ok");
  EXPECT_LE(run.figure("target_error_of_bound"), 1);
  EXPECT_LE(run.figure("line_deviation_mm"), 0.01);
  EXPECT_LE(run.figure("line_tilt_deg"), 0.01);
}

TEST(Sr1Biopsy, ComesToTheTargetTwiceInTheSameWay) {
  const DeploymentRun first = biopsy(), second = biopsy();
  expect_inserted(first);
  EXPECT_EQ(first.report, second.report);
  EXPECT_NEAR(first.figure("target_error_mm"), 0.253, 0.001);
  EXPECT_NEAR(first.figure("predicted_target_error_rms_mm"), 0.298, 0.001);
  EXPECT_NEAR(first.figure("predicted_target_error_95_mm"), 0.677, 0.001);
}

TEST(Sr1Biopsy, ASlidingNeedleGoesInWithoutAnyOtherJoint) {
  const DeploymentRun run = biopsy();
  EXPECT_LE(run.figure("other_joints_deg"), 1e-9) << run.text();
}

TEST(Sr1Biopsy, SixTurningJointsKeepTheNeedleOnTheLineAsWell) {
  const DeploymentRun run = biopsy({kSixTurningJoints});
  expect_inserted(run);
  EXPECT_GT(run.figure("other_joints_deg"), 10);
}

TEST(Sr1Biopsy, ANeedleThatIsStoppedInTheHeadStaysOnItsLine) {
  for (const char* end : {"7.1", "7.4", "9.2"}) {  // s: two of the insertion, one of the withdrawal
    SCOPED_TRACE(end);
    const DeploymentRun run = biopsy({kSixTurningJoints, std::string{"run.time_limit_s="} + end});
    EXPECT_LE(run.figure("line_deviation_mm"), 1e-6) << run.text();
  }
}

TEST(Sr1Biopsy, ANeedleThatTrailsItsWayStops) {
  const DeploymentRun run = biopsy({"components.arm.params.lag_s=0.1"});
  EXPECT_EQ(run.status(), "refused") << run.text();
  EXPECT_NE(run.word("reason").find(" away from the reference (max_tip_deviation_m "),
            std::string::npos)
      << run.text();
}

TEST(Sr1Biopsy, SolversRegistrationsAndTrajectoriesAreSwappedByOneWord) {
  for (const char* swap : {"components.motion.ik.plugin=ik/numeric",
                           "components.registration.plugin=registration/affine4",
                           "components.registration.plugin=registration/frame3",
                           "components.motion.trajectory.plugin=trajectory/cubic_spline"}) {
    SCOPED_TRACE(swap);
    expect_inserted(biopsy({swap}));
    expect_inserted(biopsy({swap, kSixTurningJoints}));
  }
}

/// It ends by itself, with the reason; the needle has not moved towards the head.
void expect_refused(const std::vector<std::string>& settings, const std::string& reason) {
  const DeploymentRun run = biopsy(settings);
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.status(), "refused");
  EXPECT_NE(run.command.err.find("refused: " + reason), std::string::npos);
  EXPECT_FALSE(run.tells("target_error_mm"));
  EXPECT_FALSE(run.tells("line_deviation_mm"));
}

const std::string kHead = "components.head.params.";

TEST(Sr1Biopsy, AVesselInTheWayIsNamed) {
  expect_refused(
      {kHead + "vessels_mm=[6, 30, 45, 6, 30, 45, 4]"},
      "path: the needle leaves -0.97 mm to 'vessel 1 (made 0.68 mm larger by the error of the "
      "registration)', 2 mm are required");
  expect_refused({kHead + "vessels_mm=[10, 5, 12, 10, 5, 12, 8]"}, "path: the needle leaves -9");
}

/// From here every way to the stand-off led the needle through the head, 24 mm under the skin.
TEST(Sr1Biopsy, AWayThroughTheHeadIsNoWay) {
  expect_refused({kHead + "head_mm=[330, 240, 320]", kHead + "head_rpy_deg=[-0.874, -31.682, 0]"},
                 "links: link 'forearm' comes nearer than 1 mm (min_link_clearance_mm) to 'head "
                 "(made 0.68 mm larger");
}

TEST(Sr1Biopsy, AnEntryAndATargetThatDoNotFitTheHeadAreRefused) {
  expect_refused({kHead + "entry_mm=[10, 5, 12]", kHead + "target_mm=[0, 60, 70]"},
                 "the target is 9.2 mm outside of the head");
  expect_refused(
      {kHead + "entry_mm=[10, 5, 12]", kHead + "target_mm=[0, 40, 60]"},
      "the entry is 66.6 mm deep in the head and the target 10.9 mm: are they exchanged?");
  expect_refused({kHead + "target_mm=[10, 5, 200]"}, "the target is 117.3 mm outside of the head");
  expect_refused({kHead + "entry_mm=[0, 40, 60]"},
                 "the entry is 10.9 mm deep in the head, 5 mm are allowed (max_entry_depth_mm)");
  expect_refused({kHead + "head_radius_mm=95", "components.motion.path.params.stand_off_mm=5"},
                 "path: the needle leaves 0.48 mm to 'head (made 0.68 mm larger");
}

TEST(Sr1Biopsy, MarkersThatDecideNothingAreRefused) {
  expect_refused({kHead + "markers_mm=[0, 0, 0, 30, 0, 0, 50, 0, 0, 90, 0, 0]"},
                 "the markers lie nearly on one line");
  expect_refused({kHead + "markers_mm=[0, 0, 0, 90, 0, 0, 0, 70, 0, 90, 70, 0]"},
                 "ambiguous: markers ");
  expect_refused({"components.registration.plugin=registration/affine4",
                  kHead + "markers_mm=[0, 0, 0, 90, 0, 0, 10, 70, 0, 70, 50, 1]"},
                 "markers 1 to 4 lie nearly in one plane");
}

TEST(Sr1Biopsy, AMarkerThatMovedOrATargetKnownTooBadlyIsRefused) {
  expect_refused({kHead + "marker_error_mm=8"}, "no choice of measured points keeps");
  expect_refused({"components.task.params.max_tre_mm=0.3"},
                 "the target is known to 0.68 mm (95 %), 0.3 mm are required");
  expect_refused({"components.task.params.max_fre_mm=0.3"},
                 "the markers fit to 0.54 mm rms, 0.3 mm are allowed");
}

TEST(Sr1Biopsy, AMarkersErrorThatDoesNotExplainTheFitIsNotBelieved) {
  expect_refused({"components.task.params.marker_error_mm=0.02"},
                 "the markers fit to 0.54 mm, which an error of 0.02 mm a marker does not explain");
}

TEST(Sr1Biopsy, AStoryThatIsNotHeardToItsEndTellsThatFirst) {
  const DeploymentRun run = biopsy({"run.time_limit_s=3"});
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.word("reason"), "the time limit of 3 s was over before the end of the scenario")
      << run.text();
}

TEST(Sr1Biopsy, AHeadOutOfReachIsRefused) {
  expect_refused({kHead + "head_mm=[1450, -120, 260]"}, "ik: the goal: out_of_reach");
}

TEST(Sr1Biopsy, ANeedlesPathMustNotBecomeAStraightJointMove) {
  const DeploymentRun run = biopsy({"components.motion.params.path_only=false"});
  EXPECT_EQ(run.command.exit_code, 3);
  EXPECT_NE(run.command.err.find("'path/needle' requires 'path_only', and nothing in component "
                                 "'motion' provides it; 'motion' does unless 'path_only' is false"),
            std::string::npos)
      << run.text();
}

}  // namespace
}  // namespace armature::test
