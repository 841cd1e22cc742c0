// SPDX-License-Identifier: Apache-2.0
// The lamp with cameras: the deployment for real ones is right as it is shipped, and pictures that
// a run has recorded, played into it, move the arm exactly as they did then.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

const std::string kCameras = source_file("configs/dental_lamp_cameras.yaml");
const std::string kPlayed = source_file("configs/overlays/played_cameras.yaml");

class LampWithCameras : public testing::Test {
 protected:
  ~LampWithCameras() override { fs::remove(recording_); }

  DeploymentRun played() const {
    const std::vector<std::string> settings{
        kSimulated, "components.task.params.auto_confirm=true",
        "components.cameras.params.recording=" + recording_.string(),
        "components.cameras.params.left_topic=left/image_raw",
        "components.cameras.params.right_topic=right/image_raw",
        // The truth, for the report; nobody sees the pictures of this scene.
        "components.scene={plugin: sim/photo_scene, out: {left_image: unseen/left, right_image: "
        "unseen/right, left_info: unseen/left_info, right_info: unseen/right_info}}",
        "components.report={plugin: report/lamp_alignment}"};
    return run_deployment({.files = {kCameras, kPlayed}, .settings = settings});
  }
  const fs::path recording_ =
      fs::temp_directory_path() / ("armature-pictures-" + std::to_string(getpid()) + ".mcap");
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
      run_deployment({.settings = {kSimulated, "record.file=" + recording_.string()}});
  expect_aligned(live);
  const DeploymentRun again = played();
  expect_aligned(again);
  EXPECT_EQ(again.word("trajectory_sha256"), live.word("trajectory_sha256"));
  EXPECT_EQ(again.figure("unpaired_pictures"), 0);
  EXPECT_GT(again.figure("pairs"), 20);
  EXPECT_EQ(again.figure("pictures"), 2 * again.figure("pairs"));
}

}  // namespace
}  // namespace armature::test
