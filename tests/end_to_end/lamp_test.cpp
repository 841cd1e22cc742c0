// SPDX-License-Identifier: Apache-2.0
// The main job: from home it finds the face and goes in front of the mouth.
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

constexpr double kStoryEndsWithin = 20;  // [s] of virtual time

TEST(Lamp, FindsADrawnFaceAndAlignsTwiceOnTheSameTrajectory) {
  const DeploymentRun first = run_deployment({.settings = {kSimulated}});
  expect_aligned(first);
  EXPECT_LE(first.figure("time_to_align_s"), kStoryEndsWithin);
  EXPECT_EQ(first.figure("replans"), 0);

  const DeploymentRun second = run_deployment({.settings = {kSimulated}});
  EXPECT_EQ(first.word("trajectory_sha256").size(), 64u);
  EXPECT_EQ(first.word("trajectory_sha256"), second.word("trajectory_sha256"));
  EXPECT_EQ(first.report, second.report);

  const DeploymentRun unwatched =
      run_deployment({.settings = {kSimulated, "components.monitor=null"}});
  EXPECT_EQ(first.report, unwatched.report) << "a monitor changes nothing";
}

TEST(Lamp, FindsAPhotographedFaceThatLooksUpAndAligns) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.scene.params.photo=astronaut",
                                   "components.scene.params.tilt_up_deg=30"}});
  expect_aligned(run);
  EXPECT_LE(run.figure("time_to_align_s"), kStoryEndsWithin);
}

}  // namespace
}  // namespace armature::test
