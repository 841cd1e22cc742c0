// SPDX-License-Identifier: Apache-2.0
// Every tilt, both photos, every swap, and the paper's own lamp.
#include <gtest/gtest.h>

#include <ostream>

#include "deployment_run.hpp"
#include "follow.hpp"

namespace armature::test {
namespace {

struct Tilt {
  std::string name;
  int up_deg, side_deg;

  friend void PrintTo(const Tilt& tilt, std::ostream* out) { *out << tilt.name; }
};

const std::vector<Tilt> kTilts{{"Tilt0", 0, 0},        {"Up15", 15, 0},   {"Up30", 30, 0},
                               {"Side15", 0, 15},      {"Side30", 0, 30}, {"SideMinus15", 0, -15},
                               {"SideMinus30", 0, -30}};

class LampMatrix : public testing::TestWithParam<std::tuple<Tilt, std::string>> {};

TEST_P(LampMatrix, FindsTheFaceAndAligns) {
  const auto& [tilt, photo] = GetParam();
  const DeploymentRun run = run_deployment(
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

TEST(LampFull, AlignsOnTheSystemClock) { expect_aligned(run_deployment({})); }

TEST(LampFull, AlignsAsThePaperHasIt) {
  const DeploymentRun run = run_deployment(
      {.files = {source_file("configs/dental_lamp_paper.yaml")}, .settings = {kSimulated}});
  expect_aligned(run, {.mouth_mm = 8, .normal_deg = 6, .distance_mm = 8, .direction_deg = 6});
}

struct Place {
  std::string name, mouth_m;
  int tilt_up_deg;

  friend void PrintTo(const Place& place, std::ostream* out) { *out << place.name; }
};

class WideSearch : public testing::TestWithParam<Place> {};

/// High and low, and looking at the lamp: the cameras of configs/rigs/default.yaml see one of them.
TEST_P(WideSearch, FindsTheFaceAndAligns) {
  const DeploymentRun run = run_deployment(
      {.files = {source_file("configs/dental_lamp_wide.yaml")},
       .settings = {
           kSimulated, "components.scene.params.mouth_m=" + GetParam().mouth_m,
           "components.scene.params.tilt_up_deg=" + std::to_string(GetParam().tilt_up_deg)}});
  expect_aligned(run);
}

INSTANTIATE_TEST_SUITE_P(Places, WideSearch,
                         testing::Values(Place{"High", "[1.35, 0, 1.0]", -40},
                                         Place{"Low", "[1.2, 0, 0]", 35},
                                         Place{"HighAside", "[1.3, 0.3, 0.9]", -40},
                                         Place{"LowAside", "[1.2, -0.3, 0.1]", 40}),
                         [](const auto& place) { return place.param.name; });

/// A face, and what `armature check` counts it as (search_coverage_test.cpp).
struct CountedFace {
  std::string name, file, mouth_m;
  int tilt_up_deg, tilt_side_deg;
  bool is_seen;

  friend void PrintTo(const CountedFace& face, std::ostream* out) { *out << face.name; }
};

class SearchCoverage : public testing::TestWithParam<CountedFace> {};

TEST_P(SearchCoverage, IsWhatTheSearchFindsInOneRound) {
  const CountedFace& face = GetParam();
  const DeploymentRun run = run_deployment(
      {.files = {source_file("configs/" + face.file + ".yaml")},
       .settings = {
           kSimulated, "run.time_limit_s=17", "components.scene.params.mouth_m=" + face.mouth_m,
           "components.scene.params.tilt_up_deg=" + std::to_string(face.tilt_up_deg),
           "components.scene.params.tilt_side_deg=" + std::to_string(face.tilt_side_deg)}});
  EXPECT_EQ(run.command.err.find("task      aligning") != std::string::npos, face.is_seen)
      << run.text();
  EXPECT_NE(run.command.err.find("task      searching"), std::string::npos) << run.text();
}

INSTANTIATE_TEST_SUITE_P(
    Rigs, SearchCoverage,
    testing::Values(
        CountedFace{"DefaultSeen", "dental_lamp", "[1.45, -0.1, 0.9]", -25, 20, true},
        CountedFace{"DefaultNotWhole", "dental_lamp", "[1.25, 0, 0.98]", 0, 0, false},
        CountedFace{"PaperSeen", "dental_lamp_paper", "[1.5, 0.1, 0.5]", 5, -20, true},
        CountedFace{"PaperNotWhole", "dental_lamp_paper", "[1.25, 0.18, 0.27]", -15, 0, false},
        CountedFace{"WideSeen", "dental_lamp_wide", "[1.25, -0.25, 0.25]", 20, 25, true},
        CountedFace{"WideTurnedAway", "dental_lamp_wide", "[1.4, 0.25, 0.75]", 30, 30, false}),
    [](const auto& place) { return place.param.name; });

TEST(LampFull, NamesAFaceOutOfReach) {
  const DeploymentRun run =
      run_deployment({.files = {source_file("configs/dental_lamp_wide.yaml")},
                      .settings = {kSimulated, "run.time_limit_s=10",
                                   "components.scene.params.mouth_m=[2.3, 0, 0.5]"}});
  EXPECT_EQ(run.status(), "goals_missed");
  EXPECT_NE(run.command.err.find("m beyond reach"), std::string::npos) << run.text();
}

TEST(LampFull, RaisesTheLightInADarkRoomAndAligns) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.scene.params.gain=0.3"}});
  expect_aligned(run);
  EXPECT_NE(run.command.err.find("task      light level 10 %"), std::string::npos) << run.text();
}

TEST(LampFull, MeetsItsGoalsAtTheDistanceThatTheTaskAloneIsTold) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.task.params.distance_m=0.4"}});
  expect_aligned(run);
  EXPECT_NEAR(run.figure("distance_mm"), 400, 1.5);
}

struct Swap {
  std::string name;
  std::vector<std::string> settings;

  friend void PrintTo(const Swap& swap, std::ostream* out) { *out << swap.name; }
};

class LampSwap : public testing::TestWithParam<Swap> {};

TEST_P(LampSwap, AlignsWithAnotherPluginByOneWord) {
  std::vector<std::string> settings = GetParam().settings;
  settings.push_back(kSimulated);
  expect_aligned(run_deployment({.settings = settings}));
}

TEST(LampFull, AlignsWithTheFaceMeshThatWasFetchedInBothSlots) {
  const DeploymentRun run =
      run_deployment({.settings = {kSimulated, "components.landmarks.plugin=landmarks/face_mesh",
                                   "components.face.landmarks.plugin=landmarks/face_mesh"}});
  if (run.command.err.find("cannot open the face mesh") != std::string::npos) {
    GTEST_SKIP() << "tools/fetch-face-mesh was not run here";
  }
  expect_aligned(run);
}

const std::string kNumericIk = "components.motion.ik.plugin=ik/numeric";
const std::string kPaperPath = "components.motion.path.plugin=path/mouth_points";
const std::string kPaperQuintics = "components.motion.trajectory.plugin=trajectory/quintic";
const std::string kMinMax = "components.motion.select.plugin=select/minmax";

INSTANTIATE_TEST_SUITE_P(
    Slots, LampSwap,
    testing::Values(Swap{"NumericIk", {kNumericIk}}, Swap{"PaperPath", {kPaperPath}},
                    Swap{"PaperQuintics", {kPaperQuintics}},
                    Swap{"PaperPathAndQuintics", {kPaperPath, kPaperQuintics}},
                    Swap{"MinMax", {kMinMax}},
                    Swap{"All", {kNumericIk, kPaperPath, kPaperQuintics, kMinMax}}),
    [](const auto& place) { return place.param.name; });

struct NamedMove {
  std::string name;
  PatientMove move;

  friend void PrintTo(const NamedMove& named, std::ostream* out) { *out << named.name; }
};

class LampFollowsEveryWay : public testing::TestWithParam<NamedMove> {};

TEST_P(LampFollowsEveryWay, WithoutAJumpAndAlignsAgain) { expect_followed(GetParam().move); }

INSTANTIATE_TEST_SUITE_P(
    Moves, LampFollowsEveryWay,
    testing::Values(NamedMove{"OtherSide", {.move_mm = "[0,-50,0]", .tilt_side_deg = -10}},
                    NamedMove{"NearerAndUp", {.move_mm = "[-40,0,30]", .tilt_up_deg = 10}},
                    NamedMove{"FartherAndDown", {.move_mm = "[30,0,-40]", .tilt_up_deg = -10}},
                    NamedMove{"SlowWalk",
                              {.duration_s = 4, .move_mm = "[0,200,0]", .spliced_goals = 3}}),
    [](const auto& place) { return place.param.name; });

}  // namespace
}  // namespace armature::test
