// SPDX-License-Identifier: Apache-2.0
// Every tilt, both photos, every swap, and the paper's own lamp.
#include <gtest/gtest.h>

#include "lamp_run.hpp"

namespace armature::test {
namespace {

struct Tilt {
  std::string name;
  int up_deg, side_deg;
};

const std::vector<Tilt> kTilts{{"Tilt0", 0, 0},        {"Up15", 15, 0},   {"Up30", 30, 0},
                               {"Side15", 0, 15},      {"Side30", 0, 30}, {"SideMinus15", 0, -15},
                               {"SideMinus30", 0, -30}};

class LampMatrix : public testing::TestWithParam<std::tuple<Tilt, std::string>> {};

TEST_P(LampMatrix, FindsTheFaceAndAligns) {
  const auto& [tilt, photo] = GetParam();
  const LampRun run = run_lamp(
      {.settings = {kSimulated, "components.scene.params.photo=" + photo,
                    "components.scene.params.tilt_up_deg=" + std::to_string(tilt.up_deg),
                    "components.scene.params.tilt_side_deg=" + std::to_string(tilt.side_deg)}});
  expect_aligned(run);
  EXPECT_LE(run.figure("time_to_align_s"), 20);
}

INSTANTIATE_TEST_SUITE_P(AllTilts, LampMatrix,
                         testing::Combine(testing::ValuesIn(kTilts),
                                          testing::Values("generated", "astronaut")),
                         [](const auto& place) {
                           return std::get<0>(place.param).name + "_" + std::get<1>(place.param);
                         });

TEST(LampFull, AlignsOnTheSystemClock) { expect_aligned(run_lamp({})); }

TEST(LampFull, AlignsAsThePaperHasIt) {
  const LampRun run = run_lamp(
      {.files = {source_file("configs/dental_lamp_paper.yaml")}, .settings = {kSimulated}});
  expect_aligned(run, {.mouth_mm = 8, .normal_deg = 6, .distance_mm = 8, .direction_deg = 6});
}

TEST(LampFull, RaisesTheLightInADarkRoomAndAligns) {
  const LampRun run = run_lamp({.settings = {kSimulated, "components.scene.params.gain=0.3"}});
  expect_aligned(run);
  EXPECT_NE(run.command.err.find("task      light level 10 %"), std::string::npos) << run.text();
}

class LampSwap : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(LampSwap, AlignsWithAnotherPluginByOneWord) {
  std::vector<std::string> settings = GetParam();
  settings.push_back(kSimulated);
  expect_aligned(run_lamp({.settings = settings}));
}

INSTANTIATE_TEST_SUITE_P(
    Slots, LampSwap,
    testing::Values(std::vector<std::string>{"components.motion.ik.plugin=ik/numeric"},
                    std::vector<std::string>{"components.motion.path.plugin=path/mouth_points"},
                    std::vector<std::string>{"components.motion.trajectory.plugin="
                                             "trajectory/quintic"},
                    std::vector<std::string>{
                        "components.motion.path.plugin=path/mouth_points",
                        "components.motion.trajectory.plugin=trajectory/quintic"}));

}  // namespace
}  // namespace armature::test
