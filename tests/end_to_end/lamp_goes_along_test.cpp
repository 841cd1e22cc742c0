// SPDX-License-Identifier: Apache-2.0
// The lamp goes along with a patient who moves at one speed. Told the truth it shows its own lag
// alone; with two cameras what they and the filter see of a face that turns comes on top.
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

/// A patient who moves for 3 s with 50 mm/s and 10 degrees/s.
DeploymentRun run_along(int pictures_hz, bool told_the_truth, const std::string& begins_s = "7",
                        const std::string& seed = "1") {
  const std::string scene = "components.scene.params.";
  std::vector<std::string> settings{
      kSimulated,
      "components.monitor=null",
      "seed=" + seed,
      scene + "rate_hz=" + std::to_string(pictures_hz),
      scene + "move_at_s=" + begins_s,
      scene + "move_duration_s=3.2",
      scene + "move_ramp_s=0.2",
      scene + "move_mm=[0,150,0]",
      scene + "move_tilt_side_deg=30",
      "components.report.params.expect_move=true",
  };
  if (told_the_truth) {
    // Nothing of what is asserted comes from the pictures: the quicker estimator will do.
    settings.push_back("components.task.in.target=truth");
    settings.push_back("components.face.plugin=face_pose/three_point");
  }
  DeploymentRun run = run_deployment({.settings = settings});
  EXPECT_EQ(run.status(), "ok") << run.text();
  std::printf("%d Hz, from %s s, seed %s, %s: %.1f mm beside, %.1f mm off the distance, %.2f deg\n",
              pictures_hz, begins_s.c_str(), seed.c_str(), told_the_truth ? "the truth" : "as seen",
              run.figure("following_spot_mm"), run.figure("following_distance_mm"),
              run.figure("following_angle_deg"));
  return run;
}

void expect_near(const DeploymentRun& run) {
  EXPECT_LE(run.figure("following_spot_mm"), 5);
  EXPECT_LE(run.figure("following_distance_mm"), 5);
  EXPECT_LE(run.figure("following_angle_deg"), 1);
}

TEST(LampGoesAlong, ToldTheTruthItIsWithin5MillimetresAndOneDegreeAfterASecond) {
  for (const int pictures_hz : {10, 30}) expect_near(run_along(pictures_hz, true));
}

TEST(LampGoesAlong, SeenByItsCamerasItIsSo) {
  for (const int pictures_hz : {10, 30}) expect_near(run_along(pictures_hz, false));
}

/// The hardest start: the first picture that shows it comes late, and shows little. A second after
/// it the lamp is not yet as near as after others.
TEST(LampGoesAlong, AStartBetweenTwoPicturesIsCaughtUpWithLater) {
  for (const char* seed : {"1", "2"}) {
    const DeploymentRun run = run_along(10, false, "7.05", seed);
    EXPECT_LE(run.figure("following_spot_mm"), 7);
    EXPECT_LE(run.figure("following_distance_mm"), 5);
    EXPECT_LE(run.figure("following_angle_deg"), 1.2);
  }
}

}  // namespace
}  // namespace armature::test
