// SPDX-License-Identifier: Apache-2.0
// `armature bench plan`: planners and orientation interpolators side by side, in one run.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/command_line/lamp_robot.hpp"

namespace armature::test {
namespace {

CommandResult bench_plan(const std::vector<std::string>& more) {
  std::vector<std::string> command{armature(), "bench", "plan", "--robot",
                                   source_file("configs/robots/med7.yaml")};
  command.insert(command.end(), {"--motions", "60", "--repetitions", "1"});
  command.insert(command.end(), more.begin(), more.end());
  return run_command(command);
}

class BenchPlan : public testing::Test {
 protected:
  void SetUp() override {
    const auto result = bench_plan({"--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    report_ = nlohmann::json::parse(result.out);
  }
  nlohmann::json report_;
};

TEST_F(BenchPlan, EveryPlannerPlansEveryMotionAndNoneBeatsTheLeastTime) {
  std::map<std::string, double> times_least;
  int curves = 0;
  for (const auto& row : report_["plans"]) {
    SCOPED_TRACE(row.dump());
    const bool kdl = row["planner"] == "KDL VelocityProfile_Trap";
    const bool curve = row["motion"] == "curve through 20";
    EXPECT_EQ(row["planned"], kdl && curve ? 0 : 60);
    if (curve) {
      curves += kdl ? 0 : 1;
      continue;
    }
    times_least[row["planner"]] = row["times_least"];
    EXPECT_GT(row["median_s"], 0);
    EXPECT_GT(row["sample_s"], 0);
    EXPECT_GE(row["times_least"], 1 - 1e-9);
  }
  EXPECT_EQ(curves, static_cast<int>(times_least.size()) - 1);
  EXPECT_NEAR(times_least.at("KDL VelocityProfile_Trap"), 1, 1e-9);
  EXPECT_LT(times_least.at("trajectory/quintic"), 15.0 / 8) << "the quintic's peak velocity";
  EXPECT_EQ(times_least.at("trajectory/quintic"), times_least.at("trajectory/quintic_spline"));
}

TEST_F(BenchPlan, APointToPointQuinticAllocatesOnlyItsKnotsAndPieces) {
  for (const auto& row : report_["plans"]) {
    if (row["planner"] != "trajectory/quintic" || row["motion"] != "point to point") continue;
    if (row.contains("allocations")) {
      EXPECT_EQ(row["allocations"], 2);
    }
    return;
  }
  FAIL() << "there is no such row";
}

TEST_F(BenchPlan, MeasuresWhatOfACurveOfRotationsJumps) {
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : report_["interpolators"]) rows[row["interpolator"]] = row;
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_GT(rows["slerp"]["velocity_jump"], 0.1);
  EXPECT_LT(rows["squad"]["velocity_jump"], 1e-3);
  EXPECT_GT(rows["squad"]["acceleration_jump"], 1);
  for (const char* smooth : {"rotvec_bspline", "chart_bspline"}) {
    EXPECT_LT(rows[smooth]["velocity_jump"], 1e-2) << smooth;
    EXPECT_LT(rows[smooth]["acceleration_jump"], 0.1) << smooth;
  }
  EXPECT_EQ(rows["slerp"]["turn"], 1);
  for (const char* longer : {"squad", "rotvec_bspline", "chart_bspline"}) {
    EXPECT_GT(rows[longer]["turn"], 1) << longer;
  }
}

TEST(BenchPlanChoices, APlannerThatIsNotThereIsNamed) {
  const auto unknown = bench_plan({"--plugins", "trajectory/quintc"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.err, testing::HasSubstr("did you mean 'trajectory/quintic'"));
}

TEST(BenchPlanChoices, AParameterThatIsNoneIsNamedWithItsPlace) {
  const auto result = bench_plan({"--params", "{trajectory/cubic_spline: {optimum_tries: few}}"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "--params:1:43: 'optimum_tries' must be a whole number, not 'few'\n");
}

}  // namespace
}  // namespace armature::test
