// SPDX-License-Identifier: Apache-2.0
// `armature bench ik`: solvers side by side, in one run.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/temporary_folder.hpp"
#include "tests/command_line/lamp_robot.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;

CommandResult bench(const std::vector<std::string>& more) {
  std::vector<std::string> command{armature(), "bench",  "ik", "--robot",       kLamp, "--poses",
                                   "200",      "--seed", "3",  "--repetitions", "2"};
  command.insert(command.end(), more.begin(), more.end());
  return run_command(command);
}

TEST(BenchIk, ChecksEveryAnswerAndComparesWithTheBaseline) {
  const auto result = bench({"--plugins", "ik/lamp_geometric,ik/numeric", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["baseline"], "ik/lamp_geometric");
  ASSERT_EQ(report["rows"].size(), 4U);
  for (const json& row : report["rows"]) {
    EXPECT_EQ(row["reached"], 1) << row;
    EXPECT_EQ(row["wrong"], 0) << row;
    EXPECT_GT(row["median_s"], 0) << row;
    EXPECT_GE(row["p99_s"], row["median_s"]) << row;
    EXPECT_LE(row["interval_95"][0], row["times_baseline"]) << row;
    EXPECT_GE(row["interval_95"][1], row["times_baseline"]) << row;
  }
  EXPECT_EQ(report["rows"][0]["times_baseline"], 1);
}

TEST(BenchIk, ComparesWithKdlUnlessTheRobotOrTheUserHasItOtherwise) {
  const auto baseline = [](const std::string& robot, const std::vector<std::string>& more) {
    std::vector<std::string> command{armature(), "bench", "ik", "--robot", source_file(robot)};
    command.insert(command.end(), {"--poses", "20", "--repetitions", "1", "--json", "--plugins",
                                   "ik/numeric,ik/kdl"});
    command.insert(command.end(), more.begin(), more.end());
    const auto result = run_command(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["baseline"];
  };
  const std::vector<std::string> tip{"--tip", "tool0"}, numeric{"--baseline", "ik/numeric"};
  EXPECT_EQ(baseline("configs/robots/arm.urdf", tip), "ik/kdl");
  EXPECT_EQ(baseline("configs/robots/sr1.yaml", {}), "ik/kdl");
  EXPECT_EQ(baseline("configs/robots/sr1.yaml", numeric), "ik/numeric");
  EXPECT_EQ(baseline("configs/robots/dental_lamp.yaml", {}), "ik/numeric");  // coupled joints
}

TEST(BenchIk, WritesTheSolvesThePlotAndTheSummary) {
  const TemporaryFolder folder;
  const auto result = bench({"--plugins", "ik/lamp_geometric", "--near", "--out", folder.path()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("200 goals of robot 'dental_lamp' (tool), seed 3"));
  for (const char* file : {"solves.csv", "cumulative.svg", "summary.json"}) {
    EXPECT_GT(fs::file_size(folder / file), 0U) << file;
  }
}

class BenchIkFiles : public testing::Test {
 protected:
  const TemporaryFolder folder_;
};

TEST_F(BenchIkFiles, AFolderThatCannotBeMadeIsToldBeforeAnythingIsMeasured) {
  const fs::path file = folder_ / "file";
  std::ofstream{file} << "mine";
  // So many goals take hours.
  const auto result = run_command({armature(), "bench", "ik", "--robot", kLamp, "--poses",
                                   "10000000", "--out", file / "bench"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "armature: cannot make the folder '" + (file / "bench").string() +
                            "': Not a directory\n");
  const auto nameless = run_command(
      {armature(), "bench", "ik", "--robot", kLamp, "--poses", "10000000", "--out", ""});
  EXPECT_EQ(nameless.exit_code, 1);
  EXPECT_EQ(nameless.err, "armature: cannot make the folder '': Invalid argument\n");
}

TEST_F(BenchIkFiles, TheTableIsPrintedAlsoWhenAFileCannotBeWritten) {
  fs::create_directories(folder_ / "summary.json");
  const auto result = bench({"--plugins", "ik/lamp_geometric", "--out", folder_.path()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("200 goals of robot 'dental_lamp' (tool), seed 3"));
  EXPECT_EQ(result.err, "armature: cannot write '" + (folder_ / "summary.json").string() +
                            "': it is no regular file\n");
}

TEST(BenchIk, ListsASolverThatDoesNotServeTheRobotWithItsReason) {
  const auto result = bench({"--plugins", "ik/lamp_geometric,ik/rrp_zyz,ik/process"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("ik/rrp_zyz +not served: "));
  EXPECT_THAT(result.out,
              ContainsRegex("ik/process +not served: missing key 'command' in params of"));
}

TEST(BenchIk, NamesWhatIsWrongOnTheCommandLine) {
  const auto unknown = bench({"--plugins", "ik/numerc"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'ik/numeric'"));
  const auto other = bench({"--plugins", "trajectory/quintic"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_EQ(other.err,
            "armature: 'trajectory/quintic' is of kind 'trajectory', this is a bench of kind "
            "'ik'\n");
  const auto baseline = bench({"--plugins", "ik/lamp_geometric", "--baseline", "ik/numeric"});
  EXPECT_EQ(baseline.exit_code, 3);
  EXPECT_THAT(baseline.err, HasSubstr("the baseline 'ik/numeric' is not one of the solvers"));
}

TEST(BenchIk, ReadsParametersAsStrictlyAsADeployment) {
  const auto refusal = [](const std::string& params) {
    const auto result = bench({"--plugins", "ik/lamp_geometric,ik/numeric", "--params", params});
    EXPECT_EQ(result.exit_code, 3) << params;
    EXPECT_EQ(result.out, "") << params;
    return result.err;
  };
  EXPECT_EQ(refusal("{ik/numeric: {max_restarts: -1, candidates: many}}"),
            "--params:1:29: 'max_restarts' is -1, must be from 0 to 10000\n"
            "--params:1:45: 'candidates' must be a whole number, not 'many'\n");
  EXPECT_EQ(refusal("{ik/numeric: {max_restart: 3}}"),
            "--params:1:15: unknown key 'max_restart' in params of 'ik/numeric'; did you mean "
            "'max_restarts'?\n");
  EXPECT_EQ(refusal("{ik/numerc: {max_restarts: 3}}"),
            "--params:1:2: 'ik/numerc' is not measured here; did you mean 'ik/numeric'?\n");
  EXPECT_EQ(refusal("{ik/kdl: {method: lma}}"),
            "--params:1:2: 'ik/kdl' is not measured here; known: ik/lamp_geometric, ik/numeric\n");
  EXPECT_EQ(refusal("{ik/lamp_geometric: [1]}"),
            "--params:1:21: params of 'ik/lamp_geometric' must be a map, not a list\n");
  EXPECT_EQ(refusal("numeric"), "--params:1:1: must be a map from plugins to their parameters\n");
  EXPECT_THAT(refusal("{ik/numeric: {max_restarts: 3}"), HasSubstr("--params:1:"));
}

TEST(BenchIk, ASeedOrAToleranceThatIsNoneIsRefused) {
  for (const std::string seed : {"-1", "1.5", "18446744073709551616", "0x10"}) {
    const auto result = bench({"--seed=" + seed});
    EXPECT_EQ(result.exit_code, 2) << seed;
    EXPECT_THAT(result.err, HasSubstr("--seed: must be a whole number from 0 to "
                                      "18446744073709551615, not '" +
                                      seed + "'"));
  }
  for (const std::string tolerance : {"nan", "0", "-1", "inf", "1e-6 m"}) {
    EXPECT_THAT(bench({"--tolerance=" + tolerance}).err,
                HasSubstr("--tolerance: must be a positive number, not '" + tolerance + "'"));
  }
}

}  // namespace
}  // namespace armature::test
