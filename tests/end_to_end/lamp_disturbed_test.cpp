// SPDX-License-Identifier: Apache-2.0
// A lamp whose pictures are disturbed moves for nothing but the patient: 1. it stays while an
// instrument is before the mouth, and says so, 2. noise is no motion, 3. where no picture can be
// believed it searches and chases nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "deployment_run.hpp"

namespace armature::test {
namespace {

const std::string kScene = "components.scene.params.";

TEST(LampDisturbed, StaysWhereItIsWhileAnInstrumentIsBeforeTheMouthAndSaysSo) {
  const DeploymentRun run = run_deployment(
      {.settings = {kSimulated, "components.monitor=null",
                    kScene + "occluder=instrument_over_mouth", kScene + "occluder_at_s=8",
                    kScene + "occluder_duration_s=6", kScene + "move_at_s=18",
                    kScene + "move_duration_s=1", kScene + "move_mm=[0, 30, 0]",
                    "components.report.params.expect_move=true"}});
  EXPECT_EQ(run.status(), "ok") << run.text();
  const std::string& told = run.command.err + run.command.out;
  EXPECT_THAT(told, testing::ContainsRegex("holding: a face is seen but not believed: the mouth "));
  const std::size_t aligned = told.find("holding");
  EXPECT_EQ(told.find("searching", aligned), std::string::npos) << told;
}

TEST(LampDisturbed, TakesNoiseOfThirtyGreyValuesForNoMotion) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.monitor=null", kScene + "noise=30"}});
  expect_aligned(run);
}

TEST(LampDisturbed, SearchesAndChasesNothingWhereNoPictureCanBeBelieved) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.monitor=null", kScene + "noise=60",
                                   "run.time_limit_s=20"}});
  const std::string told = run.command.err + run.command.out;
  EXPECT_NE(told.find("searching 9/9"), std::string::npos) << told;
  EXPECT_EQ(told.find("aligning"), std::string::npos) << told;
}

}  // namespace
}  // namespace armature::test
