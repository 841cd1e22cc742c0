// SPDX-License-Identifier: Apache-2.0
// The lamp goes along with a patient who moves at one speed. Told the truth it shows its own lag
// alone; with two cameras what they and the filter see of a face that turns comes on top.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"

namespace armature::test {
namespace {

struct Move {
  double begins_s = 7, ends_s = 10.2;
  double turn_deg_s = 10;
};

/// A patient who moves with 50 mm/s and turns; his speed rises and falls in 0.2 s.
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
      fmt::format("{}move_tilt_side_deg={:.3f}", scene, move.turn_deg_s * (duration_s - 0.2)),
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

/// One who hardly turns is seen to move by his mouth alone.
TEST(LampGoesAlong, WheneverBetweenTwoPicturesHeBeginsAndHoweverMuchHeTurns) {
  for (const Move& move :
       {Move{.begins_s = 7.03, .turn_deg_s = 0}, Move{.begins_s = 7.06, .turn_deg_s = 10. / 3},
        Move{.begins_s = 7.09, .turn_deg_s = 20. / 3}}) {
    expect_near(run_along(10, false, move));
  }
}

/// The greatest distance of the lamp from the mouth after `begins_s`, by the table of errors.
double max_distance_m(const std::filesystem::path& table, double begins_s) {
  std::ifstream file{table};
  std::string line;
  std::getline(file, line);
  double greatest = 0;
  while (std::getline(file, line)) {
    double time_s = 0, distance_m = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf", &time_s, &distance_m) == 2 && time_s > begins_s) {
      greatest = std::max(greatest, distance_m);
    }
  }
  return greatest;
}

/// A head that turns by 60 degrees within 0.8 s is lost on the way: where it was going to be is not
/// passed.
TEST(LampGoesAlong, AHeadThatTurnsAwayFastDoesNotDrawTheLampPastIt) {
  const TemporaryFolder folder;
  const std::string scene = "components.scene.params.";
  const DeploymentRun run = run_deployment(
      {.settings = {kSimulated, scene + "move_at_s=7", scene + "move_duration_s=0.8",
                    scene + "move_tilt_side_deg=60", "components.report.params.expect_move=true"},
       .report_folder = folder.path()});
  EXPECT_EQ(run.status(), "ok") << run.text();
  const double max_m = max_distance_m(folder / "errors.csv", 7);
  EXPECT_GT(max_m, 0.499);
  EXPECT_LT(max_m, 0.53);
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
