// SPDX-License-Identifier: Apache-2.0
// SR-1 from pictures: from a volume to a needle in the true lesion, and every volume with which it
// must not go on.
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"

namespace armature::test {
namespace {

DeploymentRun biopsy(std::vector<std::string> settings = {}) {
  return run_deployment(
      {.files = {source_file("configs/sr1_from_images.yaml")}, .settings = std::move(settings)});
}

void expect_refused(const std::vector<std::string>& settings, const std::string& reason) {
  const DeploymentRun run = biopsy(settings);
  SCOPED_TRACE(run.text());
  EXPECT_EQ(run.command.exit_code, 1);
  EXPECT_EQ(run.status(), "refused");
  EXPECT_NE(run.word("reason").find(reason), std::string::npos);
  EXPECT_FALSE(run.tells("target_error_mm"));
}

const std::string kScan = "components.tomograph.params.";

TEST(Sr1FromImages, ComesToTheTrueLesionTwiceInTheSameWay) {
  const DeploymentRun first = biopsy(), second = biopsy();
  SCOPED_TRACE(first.text());
  EXPECT_EQ(first.status(), "ok");
  EXPECT_EQ(first.report, second.report);
  EXPECT_EQ(first.figure("markers_found"), 6);
  EXPECT_LE(first.figure("max_marker_error_mm"), 0.08);
  EXPECT_LE(first.figure("lesion_error_mm"), 0.08);
  EXPECT_NEAR(first.figure("lesion_volume_ml"), 0.905, 0.1);
  EXPECT_LE(first.figure("target_error_of_bound_999"), 1);
  EXPECT_GE(first.figure("vessel_distance_mm"), 4);
}

TEST(Sr1FromImages, AMarkerThatCameOffBeforeTheScanIsMissed) {
  expect_refused({kScan + "lost_markers=1"}, "5 of 6 markers were found in the volume");
  expect_refused({kScan + "lost_markers=6"}, "no marker was found in the volume");
}

TEST(Sr1FromImages, AMirroredVolumeIsFoundOutByTheRegistration) {
  expect_refused({kScan + "mirrored=true"}, "mirror");
}

/// Three, or five in one plane, fit their mirror image as well as themselves; others that lie alike
/// on both sides of a plane fit it exchanged.
TEST(Sr1FromImages, MarkersThatDoNotTellAMirroredVolumeAreRefusedUnlessSomebodyVouchesForIt) {
  const std::string marked = "components.head.params.markers_mm=";
  const std::string three = marked + "[88.633, 0, 15.628, -15.096, 85.613, 23.294, -77.942, 0, 45]";
  const std::string five =
      marked + "[85, 0, 30, -40, 75, 30, -60, -60, 30, 30, -80, 30, 55, 65, 30]";
  const std::string alike =
      marked + "[80, 30, 30, -80, 30, 30, 55, -60, 40, -55, -60, 40, 0, -20, 88]";
  const std::string untold = "the markers do not tell whether the images are mirrored";
  const std::string planner = "components.planner.params.markers=";
  expect_refused({three, planner + "3"}, untold);
  expect_refused({five, planner + "5", kScan + "mirrored=true"}, untold);
  for (const char* mirrored : {"true", "false"}) {
    expect_refused({alike, planner + "5", kScan + "mirrored=" + mirrored}, untold);
  }
  const DeploymentRun vouched =
      biopsy({three, planner + "3", "components.registration.params.handedness_vouched=true"});
  EXPECT_EQ(vouched.status(), "ok") << vouched.text();
}

TEST(Sr1FromImages, NoWayPastTheVesselsIsToldWithItsReasons) {
  expect_refused({"components.planner.params.min_vessel_distance_mm=60"},
                 "come too near to a vessel");
}

/// Of a run that left its volume in a file.
class Sr1FromAFile : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "volume.nrrd";
  const std::vector<std::string> settings_{
      "components.tomograph={plugin: image/volume, params: {path: " + file_ + "}}"};
};

TEST_F(Sr1FromAFile, AVolumeFromAFileIsAsGoodAsOneFromTheTomograph) {
  const DeploymentRun scanned = biopsy({kScan + "file=" + file_});
  const DeploymentRun read = biopsy(settings_);
  SCOPED_TRACE(read.text());
  EXPECT_EQ(read.status(), "ok");
  for (const char* figure : {"max_marker_error_mm", "lesion_error_mm", "target_error_mm"}) {
    EXPECT_EQ(read.figure(figure), scanned.figure(figure)) << figure;
  }
  std::filesystem::resize_file(file_, 1000000);
  expect_refused(settings_, "is it truncated?");
}

}  // namespace
}  // namespace armature::test
