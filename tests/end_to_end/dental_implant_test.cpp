// SPDX-License-Identifier: Apache-2.0
// A dental-implant robot: from a pivot and a hand-eye calibration over a registration to three
// bores, by one file; and every way in which it must not go on.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "implant_run.hpp"

namespace armature::test {
namespace {

const std::string kTracker = "components.tracker.params.", kTask = "components.task.params.",
                  kMotion = "components.motion.";

void expect_drilled(const DeploymentRun& run) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 0);
  EXPECT_EQ(run.status(), "ok");
  EXPECT_LE(run.figure("site_error_mm"), 0.8);
  EXPECT_LE(run.figure("line_deviation_mm"), 0.05);
  EXPECT_LE(run.figure("unexplained_error_mm"), 0.01);
}

TEST(DentalImplant, DrillsThreeSitesTwiceInTheSameWay) {
  const DeploymentRun first = implant(), second = implant();
  expect_drilled(first);
  EXPECT_EQ(first.report, second.report);
  EXPECT_NEAR(first.figure("site_error_rms_mm"), 0.31, 0.02);
  EXPECT_NEAR(first.figure("expected_error_rms_mm"), 0.25, 0.02);
}

DeploymentRun with_implants(std::vector<std::string> settings = {}) {
  return run_deployment({.files = {source_file("configs/dental_implant.yaml")},
                         .settings = std::move(settings),
                         .domain = unique_dds_domain()});
}

TEST(DentalImplant, PlacesAnImplantInEveryBoreTwiceInTheSameWay) {
  const DeploymentRun first = with_implants(), second = with_implants();
  expect_drilled(first);
  EXPECT_EQ(first.report, second.report);
  EXPECT_LE(first.figure("implant_error_mm"), 0.8);
  EXPECT_LE(first.figure("implant_deviation_mm"), 0.05);
  EXPECT_LE(first.figure("thread_error_mm"), 1e-6) << "the simulated handpiece follows at once";
  EXPECT_GT(first.figure("time_to_placed_s"), first.figure("time_to_drilled_s") + 3 * 10)
      << "an implant is turned in slowly";
  EXPECT_LE(first.figure("final_speed_rad_s"), 1e-9);
}

/// Behind by its lag times the speed along the thread, 1.2 mm for 2 pi at 5 rad/s.
TEST(DentalImplant, AHandpieceThatLagsIsMeasuredAndOneThatLagsTooMuchStopsTheArm) {
  const DeploymentRun behind = with_implants({"components.handpiece.params.lag_s=0.05"});
  EXPECT_EQ(behind.status(), "ok") << behind.text();
  EXPECT_NEAR(behind.figure("thread_error_mm"), 0.05 * 1.2 * 5 / (2 * M_PI), 0.002);
  const DeploymentRun stopped = with_implants({"components.handpiece.params.lag_s=0.4"});
  EXPECT_EQ(stopped.status(), "refused") << stopped.text();
  EXPECT_EQ(stopped.word("reason").find("implant 1: the implant went in by "), 0u)
      << stopped.word("reason");
  EXPECT_LE(stopped.figure("final_speed_rad_s"), 1e-9);
}

TEST(DentalImplant, WithoutAHandpieceNoImplantIsPlacedAndNothingMoves) {
  const DeploymentRun run =
      with_implants({"components.handpiece=null", "components.threading=null"});
  EXPECT_EQ(run.status(), "refused") << run.text();
  EXPECT_EQ(run.word("reason"),
            "the plan has implants, and no handpiece tells how far it turns them");
}

TEST(DentalImplant, WithoutAnyErrorOfItsSourcesTheDrillIsAtEverySite) {
  const DeploymentRun run =
      implant({kTracker + "sphere_error_mm=0", kTracker + "marker_error_mm=0"});
  expect_drilled(run);
  EXPECT_LE(run.figure("site_error_mm"), 1e-3);
  EXPECT_LE(run.figure("site_angle_deg"), 1e-3);
}

/// Each source of error alone: what the budget names is what there is.
TEST(DentalImplant, TheBudgetNamesTheSourceThatErrs) {
  const DeploymentRun markers = implant({kTracker + "sphere_error_mm=0"});
  expect_drilled(markers);
  EXPECT_NEAR(markers.figure("site_error_rms_mm"), markers.figure("registration_error_mm"), 1e-3);
  EXPECT_GE(markers.figure("registration_error_mm"), 0.05);
  const DeploymentRun spheres = implant({kTracker + "marker_error_mm=0"});
  expect_drilled(spheres);
  EXPECT_LE(spheres.figure("registration_error_mm"), 1e-6);
  EXPECT_GE(spheres.figure("tool_error_mm"), 1e-3);
  EXPECT_LE(spheres.figure("site_error_mm"), 0.25);
}

TEST(DentalImplant, TurnsFromSiteToSiteByAnyInterpolator) {
  std::map<std::string, DeploymentRun> runs;
  for (const char* interpolator : {"slerp", "squad", "rotvec_bspline", "chart_bspline"}) {
    SCOPED_TRACE(interpolator);
    runs[interpolator] = implant({kMotion + "path.params.interpolator=" + interpolator});
    EXPECT_LE(runs[interpolator].figure("site_error_mm"), 0.8);
  }
  const auto of = [&](const char* interpolator, const char* figure) {
    return runs[interpolator].figure(figure);
  };
  // Of velocity and acceleration on the planned curve, at its keys: C0, C1, C2 and C2.
  EXPECT_GE(of("slerp", "planned_turn_jump"), 0.3);
  EXPECT_GE(of("squad", "planned_turn_jump"), 0.3);
  for (const char* rough : {"slerp", "squad"}) {
    EXPECT_EQ(runs[rough].status(), "goals_missed") << rough;
    EXPECT_EQ(runs[rough].word("reason").find("planned_turn_jump is "), 0u) << rough;
  }
  for (const char* smooth : {"rotvec_bspline", "chart_bspline"}) {
    EXPECT_LE(of(smooth, "planned_turn_jump"), 0.01) << smooth;
    expect_drilled(runs[smooth]);
  }
  // The shortest way is slerp's, whose corners cost acceleration and time.
  EXPECT_LE(of("slerp", "total_rotation_deg"), of("chart_bspline", "total_rotation_deg"));
  EXPECT_LE(of("chart_bspline", "total_rotation_deg"), of("squad", "total_rotation_deg"));
  EXPECT_GE(of("slerp", "peak_angular_acceleration_deg_s2"),
            1.3 * of("chart_bspline", "peak_angular_acceleration_deg_s2"));
  EXPECT_GE(of("slerp", "time_to_drilled_s"), of("chart_bspline", "time_to_drilled_s") + 5);
  // Only squad turns between two keys of one orientation: inside the bone.
  EXPECT_GE(of("squad", "line_tilt_deg"), 0.2);
  for (const char* straight : {"slerp", "rotvec_bspline", "chart_bspline"}) {
    EXPECT_LE(of(straight, "line_tilt_deg"), 0.001) << straight;
  }
}

/// On a C2 curve the acceleration's step from sample to sample shrinks with the samples.
TEST(DentalImplant, TheTurnThatWasExecutedHasAContinuousAcceleration) {
  const DeploymentRun coarse = implant(), fine = implant({"executors.control.period_s=0.0005",
                                                          kMotion + "params.rate_hz=2000",
                                                          "components.arm.params.rate_hz=2000"});
  expect_drilled(fine);
  EXPECT_LE(coarse.figure("acceleration_jump_of_peak"), 0.02);
  EXPECT_NEAR(fine.figure("acceleration_jump_of_peak") / coarse.figure("acceleration_jump_of_peak"),
              0.5, 0.05)
      << coarse.text() << fine.text();
}

TEST(DentalImplant, SolversAndTrajectoriesAreSwappedByOneWord) {
  for (const char* swap :
       {"ik.plugin=ik/numeric", "select.plugin=select/minmax",
        "trajectory.plugin=trajectory/cubic_spline", "trajectory.plugin=trajectory/quintic"}) {
    SCOPED_TRACE(swap);
    expect_drilled(implant({kMotion + swap}));
  }
}

TEST(DentalImplant, OtherRegistrationsDoWhereTheMarkersAreGoodEnough) {
  for (const char* plugin : {"registration/affine4", "registration/frame3"}) {
    SCOPED_TRACE(plugin);
    const std::string swap = std::string{"components.registration.plugin="} + plugin;
    expect_drilled(
        implant({swap, kTracker + "marker_error_mm=0.15", kTask + "marker_error_mm=0.15"}));
    expect_refused({swap}, " mm (95 %), 1.5 mm are required");
  }
}

TEST(DentalImplant, AnArmThatLagsHasNotDrilledUnlessItStopsAtTheBottoms) {
  const std::string lag = "components.arm.params.lag_s=0.05";
  const std::string joints = "components.motion.params.max_deviation_rad=0.1";
  const std::string tip = "components.motion.params.max_tip_deviation_m=0.1";
  const DeploymentRun short_of_it = implant({lag, joints, tip});
  EXPECT_EQ(short_of_it.command.exit_code, 1) << short_of_it.text();
  EXPECT_EQ(short_of_it.status(), "refused");
  EXPECT_NE(short_of_it.word("reason").find("the drill came no nearer than "), std::string::npos)
      << short_of_it.text();
  expect_drilled(implant({lag, joints, tip, kTask + "stop_at_sites=true"}));
}

TEST(DentalImplant, AFastTrackerWithALongLatencyDoesAsWell) {
  expect_drilled(implant({kTracker + "rate_hz=250", kTracker + "latency_s=0.05"}));
}

TEST(DentalImplant, ATrackerThatGoesBlindIsNamedAndTheArmHolds) {
  expect_refused({kTracker + "jaw_hidden_s=[40, 1000]"},
                 "the tracker has not seen the jaw for 0.50 s: its spheres are hidden");
  expect_refused({kTracker + "flange_hidden_s=[40, 1000]"},
                 "the tracker has not seen the flange for 0.50 s: its spheres are hidden");
  expect_drilled(implant({kTracker + "jaw_hidden_s=[40, 40.4]"}));
}

TEST(DentalImplant, ATrackerThatIsBlindForAWhileDuringTheCalibrationCostsPoses) {
  const DeploymentRun some = implant({kTracker + "flange_hidden_s=[1, 1.4, 10, 16]"});
  expect_drilled(some);
  EXPECT_NE(some.command.err.find("hand-eye: 17 of 20 poses fit to"), std::string::npos)
      << some.text();
  expect_refused({kTracker + "flange_hidden_s=[10, 1000]"},
                 "hand-eye: 11 of 20 poses at most, 12 are needed; pose ");
  expect_refused({kTracker + "flange_hidden_s=[1, 2]"},
                 "pivot: the tracker has not seen the drill in the hand for 0.50 s");
}

TEST(DentalImplant, AnotherBodyOnTheJawsTopicIsNotTheJaw) {
  expect_refused({"components.task.in.jaw=tracker/flange"},
                 "the tracker has not seen the jaw for 0.52 s: its topic tells of the body "
                 "'flange', not of 'jaw'");
}

TEST(DentalImplant, AJawThatMovesStopsTheArm) {
  expect_refused({kTracker + "jaw_shift_mm=[0, 2, 0]", kTracker + "jaw_shift_at_s=42"},
                 "the jaw has moved by 2.0");
}

TEST(DentalImplant, AJawThatMovesWhileItsPlaceIsAveragedIsNotDrilled) {
  expect_refused({kTracker + "jaw_shift_mm=[0, 2, 0]", kTracker + "jaw_shift_at_s=33.5"},
                 " mm while its place was averaged, 1 mm are allowed");
}

/// The hand-eye calibration ends at 33.06 s; the jaw is seen for its place from 33.08 s on. Whoever
/// does not look drills as far off as the tracker was knocked, and tells of 0.43 mm.
TEST(DentalImplant, ATrackerThatIsKnockedBehindItsCalibrationIsFoundBeforeTheDrillSetsOut) {
  const std::string shift = kTracker + "stand_shift_mm=[0, 20, 0]",
                    at = kTracker + "stand_shift_at_s=33.07";
  expect_refused({shift, at}, "the tracker sees the body on the flange 20.0");
  const DeploymentRun unwatched = implant({shift, at, kTask + "max_flange_error_mm=100"});
  EXPECT_NEAR(unwatched.figure("site_error_mm"), 20, 1) << unwatched.text();
}

TEST(DentalImplant, ATrackerThatIsKnockedWhileItDrillsStopsTheArm) {
  expect_refused({kTracker + "stand_shift_mm=[0, 20, 0]", kTracker + "stand_shift_at_s=42"},
                 "the jaw has moved by ");
}

TEST(DentalImplant, AJawThatMovedAfterTheDrillingIsInTheErrorOfTheImplantsAlone) {
  const DeploymentRun run =
      with_implants({kTracker + "jaw_shift_mm=[3, 0, 0]", kTracker + "jaw_shift_at_s=56",
                     kTask + "max_jaw_motion_mm=5"});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "goals_missed");
  EXPECT_NEAR(run.figure("implant_error_mm"), 3, 0.5);
  EXPECT_LE(run.figure("site_error_mm"), 0.8);
  EXPECT_LE(run.figure("tracker_error_mm"), 0.05);
  EXPECT_LE(run.figure("unexplained_error_mm"), 0.01);
}

TEST(DentalImplant, TwoSitesAtOnePlaceAreRefused) {
  expect_refused({kTracker + "sites_mm=[10, -5, 12, 10, -5, 12]",
                  kTracker + "sites_rpy_deg=[0, 0, 0, 0, 0, 0]"},
                 "the plan: the bores of sites 1 and 2 come as near as 0.00 mm to each other");
}

TEST(DentalImplant, OfOneSiteTheErrorIsToldAndWhyNoTurnIs) {
  const DeploymentRun run =
      with_implants({kTracker + "sites_mm=[10, -5, 12]", kTracker + "sites_rpy_deg=[3, 11, 18]",
                     kTracker + "implants_mm=[0.5, 11, 1.2]"});
  expect_drilled(run);
  EXPECT_LE(run.figure("implant_error_mm"), 0.8);
  EXPECT_NE(run.report.find(R"("site_errors_mm":[)"), std::string::npos);
  EXPECT_NE(run.report.find(R"("does_not_apply":{"planned_turn_jump":"the ways through key poses)"),
            std::string::npos);
}

/// Along a limit the joints turn as sharply as the way there and on; a curve through that swings
/// out, and an arm needs its time.
TEST(DentalImplant, ASolverThatGoesAlongALimitNeedsAMargin) {
  const std::string along = kMotion + "ik.params.objective=continuity";
  expect_refused({along},
                 "no sample of its path does: give the curve between them room with "
                 "limit_margin_deg (or _mm)");
  expect_drilled(implant({along, kMotion + "params.limit_margin_deg=0.1", "run.time_limit_s=400"}));
}

TEST(DentalImplant, APathThatKnowsNoKeyPosesIsRefusedBeforeAnythingMoves) {
  const DeploymentRun run =
      implant({kMotion + "path.plugin=path/needle", kMotion + "params.path_only=true",
               "components.alone={plugin: path/orientations}"});
  EXPECT_EQ(run.command.exit_code, 3);
  EXPECT_NE(
      run.command.err.find("'task' requires 'key_poses', and no component on its topics provides "
                           "it; provided by path/orientations\n"),
      std::string::npos)
      << run.text();
}

TEST(DentalImplant, ASiteOutOfReachIsRefused) {
  const std::string near_is_seen = kTracker + "min_distance_mm=100";
  expect_refused({near_is_seen, kTracker + "jaw_mm=[-1100, -50, 650]"},
                 "above site 1: ik: the goal: out_of_reach");
  expect_refused({near_is_seen, kTracker + "jaw_mm=[-620, -50, 650]"},
                 "sites 1 to 3: ik: the goal: out_of_reach");
  expect_refused({kTracker + "sites_rpy_deg=[3, 11, 18, -8, 2, 30, 90, -12, 8]"},
                 "sites 1 to 3: ik: the goal: joint_limit");
}

TEST(DentalImplant, OtherSeedsAreDrilledAsWell) {
  for (const int seed : {2, 3, 5, 8, 13}) {
    SCOPED_TRACE(seed);
    expect_drilled(implant({"seed=" + std::to_string(seed)}));
  }
}

TEST(DentalImplant, CalibrationsMarkersAndSitesThatAreKnownTooBadlyAreRefused) {
  expect_refused({kTracker + "sphere_error_mm=1"}, "pivot: the tip stood still to 1.");
  expect_refused({kTracker + "pivot_cone_deg=0"}, "pivot: ");
  expect_refused({kTracker + "marker_error_mm=4"}, "no choice of measured points keeps");
  expect_refused({kTracker + "markers_mm=[0, 0, 0, 30, 0, 0, 70, 0, 0]"},
                 "the markers lie nearly on one line");
  expect_refused({kTask + "max_tre_mm=0.3"},
                 "site 1 is known to 0.72 mm (95 %), 0.3 mm are required");
}

TEST(DentalImplant, AMarkersErrorThatDoesNotExplainTheFitIsNotBelieved) {
  expect_refused({kTask + "marker_error_mm=0.1", kTracker + "marker_error_mm=0.9"},
                 "the markers fit to 0.68 mm, which an error of 0.1 mm a marker does not explain");
}

TEST(DentalImplant, SitesWithWrongNumbersAreFoundBeforeAnythingStarts) {
  const auto problem = [](const std::string& setting) {
    const DeploymentRun run = implant({kTracker + setting});
    EXPECT_EQ(run.command.exit_code, 3) << run.text();
    return run.command.err;
  };
  EXPECT_NE(problem("sites_mm=[10, -5]").find("'sites_mm' has 2 numbers; three for each of"),
            std::string::npos);
  EXPECT_NE(
      problem("sites_rpy_deg=[1, 2, 3]").find("'sites_mm' has 3 sites, 'sites_rpy_deg' has 1"),
      std::string::npos);
  EXPECT_NE(problem("sites_mm=[10, -5, north]").find("north"), std::string::npos);
  EXPECT_NE(problem("min_distance_mm=3000")
                .find("'min_distance_mm' is 3000, not below 'max_distance_mm', which is 2400"),
            std::string::npos);
  EXPECT_NE(problem("jaw_hidden_s=[5, 4]").find("'jaw_hidden_s': from 5 s until 4 s is no time"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::test
