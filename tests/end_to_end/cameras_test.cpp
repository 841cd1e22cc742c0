// SPDX-License-Identifier: Apache-2.0
// The lamp with cameras: 1. the deployment for real ones is right as it is shipped, 2. pictures
// that a run has recorded, played into it, move the arm exactly as they did then, 3. cameras that
// freeze are refused and named, those that drift or are exchanged are told of.
#include <gtest/gtest.h>

#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"

namespace armature::test {
namespace {

const std::string kCameras = source_file("configs/dental_lamp_cameras.yaml");
const std::string kPlayed = source_file("configs/overlays/played_cameras.yaml");

const std::string kScene = "components.scene.params.";

class LampWithCameras : public testing::Test {
 protected:
  DeploymentRun played() const {
    const std::vector<std::string> settings{
        kSimulated, "components.task.params.auto_confirm=true",
        "components.cameras.params.recording=" + recording_,
        "components.cameras.params.left_topic=left/image_raw",
        "components.cameras.params.right_topic=right/image_raw",
        // The truth, for the report; nobody sees the pictures of this scene.
        "components.scene={plugin: sim/photo_scene, out: {left_image: unseen/left, right_image: "
        "unseen/right, left_info: unseen/left_info, right_info: unseen/right_info}}",
        "components.report={plugin: report/lamp_alignment}"};
    return run_deployment({.files = {kCameras, kPlayed}, .settings = settings});
  }
  const TemporaryFolder folder_;
  const std::string recording_ = folder_ / "pictures.mcap";
};

TEST_F(LampWithCameras, IsCheckedWithoutACamera) {
  const CommandResult checked = run_command({armature(), "check", kCameras});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_NE(checked.out.find("1280 x 720 pixels, f 914.0 px, baseline 120.00 mm"),
            std::string::npos)
      << checked.out;
}

TEST_F(LampWithCameras, IsRefusedWithARigOfOtherCamerasThanTheCalibrations) {
  const CommandResult checked =
      run_command({armature(), "check", kCameras, "--set",
                   "rigs.head=" + source_file("configs/rigs/paper.yaml")});
  EXPECT_EQ(checked.exit_code, 3);
  EXPECT_NE(checked.err.find(
                "component 'pair': the calibration gives another pair of cameras than the "
                "rig 'paper'; write into the rig resolution: [1280, 720], focal_px: 914.015"),
            std::string::npos)
      << checked.err;
}

TEST_F(LampWithCameras, GoesWhereItWentWhenItsPicturesArePlayedAgain) {
  const DeploymentRun live =
      run_deployment({.settings = {kSimulated, "record.file=" + recording_}});
  expect_aligned(live);
  const DeploymentRun again = played();
  expect_aligned(again);
  EXPECT_EQ(again.word("trajectory_sha256"), live.word("trajectory_sha256"));
  EXPECT_EQ(again.figure("unpaired_pictures"), 0);
  EXPECT_GT(again.figure("pairs"), 20);
  EXPECT_EQ(again.figure("pictures"), 2 * again.figure("pairs"));
}

/// Until shortly after the lamp has seen the face.
DeploymentRun with_fault(const std::vector<std::string>& scene) {
  std::vector<std::string> settings{kSimulated, "run.time_limit_s=8"};
  for (const std::string& one : scene) settings.push_back(kScene + one);
  return run_deployment({.settings = settings});
}

TEST(LampWhoseCameras, FreezeSaysWhichOneAndAlignsToNoPictureOfIt) {
  for (const std::string which : {"left", "both"}) {
    const DeploymentRun run = with_fault({"frozen=" + which, "frozen_at_s=3.8"});
    const std::string who = which == "left" ? "the left camera is" : "both cameras are";
    EXPECT_NE(run.text().find(who + " frozen: the same picture again"), std::string::npos)
        << run.text();
    EXPECT_EQ(run.status(), "goals_missed") << run.text();
  }
}

TEST(LampWhoseCameras, FreezeWhileThePatientMovesStaysWhereItIsAndSaysWhy) {
  const DeploymentRun run = run_deployment(
      {.settings = {kSimulated, "run.time_limit_s=14", "components.report.params.expect_move=true",
                    kScene + "move_at_s=7", kScene + "move_duration_s=3",
                    kScene + "move_mm=[0, 200, 0]", kScene + "frozen=right",
                    kScene + "frozen_at_s=7.2"}});
  const std::string told = run.command.err + run.command.out;
  const std::size_t aligned = told.find("holding");
  ASSERT_NE(aligned, std::string::npos) << told;
  EXPECT_NE(told.find(": no picture could be used for 2 s: the right camera is frozen"),
            std::string::npos)
      << told;
  EXPECT_EQ(told.find("searching", aligned), std::string::npos) << told;
}

TEST(LampWhoseCameras, FreezeWithoutNoiseStaysWhereItIsWhenThePatientHasComeToRest) {
  for (const std::string which : {"left", "right"}) {
    const DeploymentRun run = run_deployment(
        {.settings = {kSimulated, "run.time_limit_s=14",
                      "components.report.params.expect_move=true", kScene + "noise=0",
                      kScene + "move_at_s=9", kScene + "move_duration_s=2",
                      kScene + (which == "left" ? "move_mm=[0, -30, 0]" : "move_mm=[0, 30, 0]"),
                      kScene + "frozen=" + which, kScene + "frozen_at_s=9"}});
    EXPECT_LT(std::abs(run.figure("distance_error_mm")), 1.5) << which << '\n' << run.text();
    EXPECT_EQ(run.status(), "goals_missed") << run.text();
    EXPECT_NE(run.text().find("the " + which + " camera is frozen"), std::string::npos)
        << run.text();
  }
}

TEST(LampWhoseCameras, AreExchangedAsksForItAtTheEndOfARoundOfTheSearch) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "run.time_limit_s=18",
                                   "components.scene.out={left_image: right/image_raw, "
                                   "right_image: left/image_raw}"}});
  const std::string told = run.command.err + run.command.out;
  EXPECT_NE(told.find("are the left and the right camera exchanged?"), std::string::npos) << told;
  EXPECT_EQ(told.find("aligning"), std::string::npos) << told;
}

TEST(LampWhoseCameras, DriftIsWarnedWhileItsGoalsAreStillMet) {
  const DeploymentRun run = with_fault({"right_roll_deg=0.07"});
  EXPECT_NE(run.text().find("the cameras are no longer well calibrated"), std::string::npos)
      << run.text();
  expect_aligned(run);
}

TEST(LampWhoseCameras, HaveNoNoiseAndSeeAStillFaceAreNotFrozen) {
  const DeploymentRun run = with_fault({"noise=0"});
  EXPECT_EQ(run.text().find("frozen"), std::string::npos) << run.text();
  expect_aligned(run);
}

}  // namespace
}  // namespace armature::test
