// SPDX-License-Identifier: Apache-2.0
// The master manipulator: from the instrument's pose to a follower that a hand leads, by one file;
// and every way in which the follower must stand still.
#include <gtest/gtest.h>

#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"

namespace armature::test {
namespace {

DeploymentRun teleoperation(std::vector<std::string> settings = {}) {
  return run_deployment(
      {.files = {source_file("configs/master_manipulator.yaml")}, .settings = std::move(settings)});
}

const std::string kSurgeon = "components.surgeon.params.", kTask = "components.task.params.",
                  kReport = "components.report.params.";

/// Without an incision: the paper's follower, whose instrument moves freely.
const std::vector<std::string> kFree{"components.motion.params.remote_centre=false",
                                     kSurgeon + "incision_mm=[]",
                                     "goals.incision_deviation_mm=null"};
std::vector<std::string> freely(std::vector<std::string> settings = {}) {
  settings.insert(settings.end(), kFree.begin(), kFree.end());
  return settings;
}

/// Whatever the hand does.
void expect_shaft_in_incision(const DeploymentRun& run) {
  SCOPED_TRACE(run.text());
  EXPECT_LE(run.figure("incision_deviation_mm"), 0.1);
  EXPECT_GE(run.figure("min_depth_mm"), 10);
}

void expect_teleoperated(const DeploymentRun& run) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 0);
  EXPECT_EQ(run.status(), "ok");
  EXPECT_LE(run.figure("alignment_error_mm"), 0.01);
  EXPECT_LE(run.figure("alignment_error_deg"), 0.001);
  EXPECT_LE(run.figure("peak_speed_error_percent"), 0.1);
  EXPECT_LE(run.figure("tracking_error_mm"), 0.1);
  EXPECT_LE(run.figure("tremor_db"), -20);
  EXPECT_LE(run.figure("tip_speed_mm_s"), 50);
  EXPECT_LE(run.figure("clutch_motion_mm"), 0.001);
  EXPECT_LE(run.figure("closing_step_mm"), 0.01);
}

TEST(MasterManipulator, AlignsAndDrivesTheFollowerTwiceInTheSameWay) {
  const DeploymentRun first = teleoperation(), second = teleoperation();
  expect_teleoperated(first);
  expect_shaft_in_incision(first);
  EXPECT_EQ(first.report, second.report);
  EXPECT_LE(first.figure("alignment_error_mm"), 1e-9);
  EXPECT_LE(first.figure("tracking_error_mm"), 0.005);
  EXPECT_NEAR(first.figure("measured_lag_ms"), 48.6, 0.1) << "the lag that the file states";
  EXPECT_NEAR(first.figure("hand_tremor_mm"), 0.1, 0.01);
  EXPECT_GT(first.figure("tip_speed_mm_s"), 20);
}

TEST(MasterManipulator, SolversSelectorsAndTrajectoriesAreSwappedAndLimitsLowered) {
  const std::string follower_ik = "components.motion.ik.";
  const std::vector<std::vector<std::string>> swaps{
      {follower_ik + "plugin=ik/numeric", follower_ik + "params=null"},
      {follower_ik + "params.objective=limits"},
      {"components.motion.params.max_jerk_rad_s3=100"},
      {"components.motion.select.plugin=select/minmax"},
      {"components.leader_motion.ik.plugin=ik/numeric"},
      {"components.leader_motion.trajectory.plugin=trajectory/quintic_spline"},
      {"components.leader_motion.select.plugin=select/minmax"}};
  for (const auto& swap : swaps) {
    SCOPED_TRACE(swap.front());
    const DeploymentRun run = teleoperation(swap);
    expect_teleoperated(run);
    expect_shaft_in_incision(run);
  }
}

/// A lift, a rail and a turn that stand still, with the tip where the arm alone has it.
TEST(MasterManipulator, AFollowerOnAMobileBaseThatIsLockedDoesTheSame) {
  const DeploymentRun run =
      teleoperation({"robots.follower=" + source_file("configs/robots/med7_scope_mobile.yaml")});
  expect_teleoperated(run);
  EXPECT_LE(run.figure("incision_deviation_mm"), 0.2);
}

TEST(MasterManipulator, AnyHandsTremorIsTakenOut) {
  for (const char* seed : {"seed=2", "seed=3", "seed=4"}) {
    SCOPED_TRACE(seed);
    const DeploymentRun run = teleoperation({seed});
    expect_teleoperated(run);
    expect_shaft_in_incision(run);
  }
}

TEST(MasterManipulator, TheFollowerIsJudgedByTheScaleThatItWasGiven) {
  expect_teleoperated(teleoperation({kTask + "scale=0.25"}));
  const DeploymentRun two = teleoperation({kTask + "scale=0.25", kReport + "scale=0.5"});
  EXPECT_EQ(two.command.exit_code, 3);
  EXPECT_NE(two.command.err.find("'scale' of component 'report' must be the same as that of "
                                 "component 'task'"),
            std::string::npos)
      << two.text();
}

TEST(MasterManipulator, OfAHandThatIsTooFastTheFollowerKeepsItsTopSpeed) {
  const DeploymentRun run =
      teleoperation(freely({kSurgeon + "curve_mm=[-30, 30, 20]", kSurgeon + "curve_hz=0.4"}));
  EXPECT_GT(run.figure("tip_speed_mm_s"), 45) << run.text();
  EXPECT_LE(run.figure("tip_speed_mm_s"), 50);
  EXPECT_EQ(run.status(), "goals_missed") << "it does not follow then";
  EXPECT_GT(run.figure("tracking_error_mm"), 0.1);
  EXPECT_LE(run.figure("clutch_motion_mm"), 0.001);
}

/// It ends by itself with a reason, and the follower stands.
void expect_ended(const DeploymentRun& run, const std::string& status, const std::string& reason) {
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.status(), status);
  EXPECT_NE(run.command.err.find(status + ": " + reason), std::string::npos);
}

TEST(MasterManipulator, AnInstrumentOutOfTheLeadersReachIsRefusedAndNothingMoves) {
  const DeploymentRun run = teleoperation({kSurgeon + "console_mm=[922, -122, 79]"});
  expect_ended(run, "refused",
               "the leader cannot come to the instrument: ik: the goal: out_of_reach");
  EXPECT_EQ(run.figure("tip_speed_mm_s"), 0);
}

TEST(MasterManipulator, AMoveThatTheLeadersLimitsForbidInThePapersTimeIsRefused) {
  const DeploymentRun run = teleoperation({"components.leader_motion.path.params.duration_s=0.5"});
  expect_ended(run, "refused",
               "the leader cannot come to the instrument: trajectory: segment 1 lasts");
}

TEST(MasterManipulator, AFollowerThatCannotFollowIsHeld) {
  const DeploymentRun run =
      teleoperation(freely({kTask + "scale=10", kTask + "max_tip_speed_m_s=1",
                            "components.motion.params.max_tracking_velocity_m_s=1"}));
  expect_ended(run, "held", "the follower cannot follow: ik: the goal: ");
}

TEST(MasterManipulator, AFollowerThatIsTooSlowForTheHandIsTold) {
  const DeploymentRun run = teleoperation({"components.motion.params.max_velocity_rad_s=0.1"});
  EXPECT_NE(run.command.err.find("the instrument trails its target by more than 2 mm"),
            std::string::npos)
      << run.text();
}

TEST(MasterManipulator, WithoutAnIncisionTheFollowerIsAsGood) {
  expect_teleoperated(teleoperation(freely()));
}

TEST(MasterManipulator, TheShaftStaysInTheIncisionOfAHandThatIsTooFast) {
  expect_shaft_in_incision(
      teleoperation({kSurgeon + "curve_mm=[-30, 30, 20]", kSurgeon + "curve_hz=0.4"}));
}

TEST(MasterManipulator, ATipThatCannotGoWithTheHandWaitsAtTheBorderAndSaysWhy) {
  const DeploymentRun run = teleoperation({kTask + "scale=10", kTask + "max_tip_speed_m_s=1",
                                           "components.motion.params.max_tracking_velocity_m_s=1"});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "goals_missed") << "it does not follow then, and is not held either";
  EXPECT_NE(run.command.err.find("the tip waits before its target: the goal: joint_limit"),
            std::string::npos);
  expect_shaft_in_incision(run);
}

TEST(MasterManipulator, AnIncisionThatTheShaftIsNotInHoldsTheFollowerAndNothingMoves) {
  const DeploymentRun run = teleoperation({kSurgeon + "incision_mm=[551.533, -63.43, 267.141]"});
  expect_ended(run, "held",
               "the follower cannot follow: accept: the shaft passes the incision at (0.5515, "
               "-0.0634, 0.2671) m by 36.96 mm, more than max_incision_offset_mm, 1: register the "
               "incision where the shaft is, or bring the shaft through it");
  EXPECT_EQ(run.figure("tip_speed_mm_s"), 0);
}

/// A file for the knife: so much of each way, in so many seconds.
class KnifePath {
 public:
  explicit KnifePath(const std::string& rows) {
    std::ofstream{file_} << "t,x,y,z,qx,qy,qz,qw\n" << rows;
  }
  std::string setting() const { return kSurgeon + "path=" + file_; }

 private:
  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "knife.csv";
};

TEST(MasterManipulator, AKnifeGoesAPlannedPathAboutTheIncision) {
  const KnifePath path{
      "0, 0.55, 0, 0.2, 0, 0, 0, 1\n"
      "2, 0.56, 0.01, 0.195, 0, 0, 0, 1\n"
      "4, 0.555, 0.02, 0.19, 0, 0, 0.0998334, 0.9950042\n"};
  const DeploymentRun run = teleoperation({path.setting()});
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.status(), "ok");
  EXPECT_LE(run.figure("tracking_error_mm"), 0.1);
  EXPECT_LE(run.figure("incision_deviation_mm"), 0.1);
  EXPECT_GT(run.figure("tip_speed_mm_s"), 5);
}

TEST(MasterManipulator, APlannedPathWithANumberThatIsNoneIsRefusedWithItsLine) {
  const KnifePath path{"0, 0.55, 0, 0.2, 0, 0, 0, 1\n1, 0.56, nan, 0.2, 0, 0, 0, 1\n"};
  const DeploymentRun run = teleoperation({path.setting()});
  EXPECT_EQ(run.command.exit_code, 3);
  EXPECT_NE(run.command.err.find("knife.csv:3: y is nan, not a finite number"), std::string::npos)
      << run.text();
}

TEST(MasterManipulator, AHandThatFallsSilentHoldsTheFollower) {
  const DeploymentRun run = teleoperation({kSurgeon + "silent_after_s=3"});
  expect_ended(run, "held", "the clutch tells nothing");
  expect_shaft_in_incision(run);
  EXPECT_LE(run.figure("clutch_motion_mm"), 0.001);
  EXPECT_LE(run.figure("stopping_mm"), 1);
}

TEST(MasterManipulator, AHandThatIsSilentBeforeItClosesTheClutchIsNamedAndEndsTheRun) {
  const DeploymentRun run = teleoperation({kSurgeon + "silent_after_s=0.1"});
  EXPECT_EQ(run.status(), "held") << run.text();
  EXPECT_EQ(run.word("reason"), "the clutch tells nothing");
  EXPECT_NE(run.command.err.find("aligned: the clutch tells nothing"), std::string::npos);
}

TEST(MasterManipulator, AMisspeltWordBeforeTheTopicsOfAnArmIsTold) {
  const DeploymentRun run = teleoperation({"components.leader.topics=leadr"});
  EXPECT_EQ(run.command.exit_code, 3);
  EXPECT_NE(
      run.command.err.find("surgeon.measured_js reads topic "
                           "'/master_manipulator/leader/arm/measured_js', which nobody writes; "
                           "did you mean '/master_manipulator/leadr/arm/measured_js'?\n"),
      std::string::npos)
      << run.text();
}

TEST(MasterManipulator, MotionsWithoutAnExecutorsPeriodHaveTheirOwn) {
  expect_teleoperated(
      teleoperation({"components.motion.executor=main", "components.leader_motion.executor=main"}));
}

TEST(MasterManipulator, OfAHandThatDoesNotTrembleNoRatioIsTold) {
  const DeploymentRun run = teleoperation({kSurgeon + "tremor_mm=0"});
  EXPECT_EQ(run.status(), "ok") << run.text();
  EXPECT_NE(run.report.find(R"("does_not_apply":{"tremor_db":"the hand trembles by 0.0)"),
            std::string::npos)
      << run.text();
}

TEST(MasterManipulator, OfAHandThatRestsNoLagIsTold) {
  const DeploymentRun run = teleoperation({kSurgeon + "curve_hz=0"});
  EXPECT_EQ(run.status(), "ok") << run.text();
  EXPECT_NE(run.report.find(R"("measured_lag_ms":"the motion does not tell: )"), std::string::npos)
      << run.text();
}

TEST(MasterManipulator, TwoArmsNeedTopicsOfTheirOwn) {
  const DeploymentRun run = teleoperation({"components.leader.topics=null"});
  EXPECT_EQ(run.command.exit_code, 3);
  EXPECT_NE(run.command.err.find("both write topic '/master_manipulator/arm/measured_js'"),
            std::string::npos)
      << run.text();
}

}  // namespace
}  // namespace armature::test
