// SPDX-License-Identifier: Apache-2.0
// The lamp goes along with a patient who moves at one speed. Told the truth it shows its own lag
// alone; with two cameras what they and the filter see of a face that turns comes on top.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

struct Move {
  double begins_s = 7, ends_s = 10.2;
};

/// A patient who moves with 50 mm/s and 10 degrees/s; his speed rises and falls in 0.2 s.
DeploymentRun run_along(int pictures_hz, bool told_the_truth, const Move& move = {}) {
  const double duration_s = move.ends_s - move.begins_s;
  const std::string scene = "components.scene.params.";
  std::vector<std::string> settings{
      kSimulated,
      "components.monitor=null",
      scene + "rate_hz=" + std::to_string(pictures_hz),
      fmt::format("{}move_at_s={}", scene, move.begins_s),
      fmt::format("{}move_duration_s={:.3f}", scene, duration_s),
      scene + "move_ramp_s=0.2",
      fmt::format("{}move_mm=[0,{:.3f},0]", scene, 50 * (duration_s - 0.2)),
      fmt::format("{}move_tilt_side_deg={:.3f}", scene, 10 * (duration_s - 0.2)),
      "components.report.params.expect_move=true",
  };
  if (told_the_truth) {
    // Nothing of what is asserted comes from the pictures: the quicker estimator will do.
    settings.push_back("components.task.in.target=truth");
    settings.push_back("components.face.plugin=face_pose/three_point");
  }
  DeploymentRun run = run_deployment({.settings = settings});
  EXPECT_EQ(run.status(), "ok") << run.text();
  fmt::print(
      "{} Hz, from {:g} to {:g} s, {}: {:.1f} mm beside, {:.1f} mm off the distance, {:.2f} deg\n",
      pictures_hz, move.begins_s, move.ends_s, told_the_truth ? "the truth" : "as seen",
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

TEST(LampGoesAlong, WheneverBetweenTwoPicturesHeBegins) {
  for (const double begins_s : {7.03, 7.06, 7.09}) {
    expect_near(run_along(10, false, {.begins_s = begins_s}));
  }
}

/// While a patient stops he is no longer where his speed in the last picture would have him.
TEST(LampGoesAlong, AStopBetweenTwoPicturesIsSeenLater) {
  const DeploymentRun run = run_along(10, false, {.ends_s = 10.25});
  EXPECT_LE(run.figure("following_spot_mm"), 7);
  EXPECT_LE(run.figure("following_distance_mm"), 5);
  EXPECT_LE(run.figure("following_angle_deg"), 1.2);
}

}  // namespace
}  // namespace armature::test
