// SPDX-License-Identifier: Apache-2.0
// `armature fk` and `armature ik`: JSON lines in, one answer per line out, whatever comes in.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/sanitizer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/command_line/lamp_robot.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

std::vector<json> answers(const std::vector<std::string>& arguments, const std::string& input) {
  const CommandResult result = run_command(arguments, {.environment = {}, .input = input});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<json> lines;
  std::istringstream out{result.out};
  for (std::string line; std::getline(out, line);) lines.push_back(json::parse(line));
  return lines;
}

std::vector<json> ik(const std::string& input, const std::string& plugin = "ik/lamp_geometric") {
  return answers({armature(), "ik", "--robot", kLamp, "--plugin", plugin}, input);
}
std::vector<json> fk(const std::string& input) {
  return answers({armature(), "fk", "--robot", kLamp}, input);
}

constexpr const char* kPaperGoal =
    R"({"position_m":[1.3,0.321,0.504],"direction":[0.894427,-0.268328,-0.357771]})"
    "\n";

TEST(IkCalculator, AnswersThePapersExampleWithAllBranches) {
  const auto lines = ik(kPaperGoal);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["status"], "ok");
  const json& first = lines[0]["solutions"][0];
  EXPECT_EQ(first["label"], "tilt0/balance0/elbow0");
  const std::vector<double> paper{1.1435, -1.3390, 0.0476, -0.0476, -0.0960, -0.3659};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(first["joints"][i].get<double>(), paper[i], 1e-4);
  EXPECT_LT(first["residual_m"].get<double>(), 1e-9);
}

TEST(IkCalculator, FindsTheSamePoseWithAnotherSolverByOneWord) {
  const auto lines = ik(kPaperGoal, "ik/numeric");
  EXPECT_EQ(lines[0]["status"], "ok");
  EXPECT_LT(lines[0]["solutions"][0]["residual_m"].get<double>(), 1e-6);
}

TEST(IkCalculator, NamesTheSolverThatCrashes) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const Command::Options goal{
      .environment = {{"ARMATURE_PLUGIN_PATH", ARMATURE_BINARY_DIR "/tests/plugins"}},
      .input = kPaperGoal};
  const CommandResult result = run_command(
      {armature(), "ik", "--robot", kLamp, "--plugin", "ik/faulty", "--params", "{fault: crash}"},
      goal);
  EXPECT_EQ(result.exit_code, 128 + SIGSEGV);
  EXPECT_NE(result.err.find("armature: plugin 'ik/faulty' crashed in its solve: SIGSEGV\n"),
            std::string::npos)
      << result.err;
}

TEST(IkCalculator, AnswersAloneStandOnStandardOutputWhateverTheSolverPrints) {
  const CommandResult result = run_command(
      {armature(), "ik", "--robot", kLamp, "--plugin", "ik/faulty", "--params", "{fault: print}"},
      {.environment = {{"ARMATURE_PLUGIN_PATH", ARMATURE_BINARY_DIR "/tests/plugins"}},
       .input = kPaperGoal});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(json::accept(result.out)) << result.out;
  EXPECT_NE(result.err.find("[solving\n"), std::string::npos) << result.err;
}

TEST(IkCalculator, AnswersEveryBadLineWithAReasonAndGoesOn) {
  const auto lines = ik(std::string{"this is not JSON\n"
                                    "[1,2,3]\n"
                                    R"({"position_m":[1.3,0.321],"direction":[1,0,0]})"
                                    "\n"
                                    R"({"position_m":[1.3,0.321,NaN],"direction":[1,0,0]})"
                                    "\n"
                                    R"({"position_m":[1.3,0.321,1e999],"direction":[1,0,0]})"
                                    "\n"
                                    R"({"position_m":[1.3,0.321,0.5],"direction":[0,0,0]})"
                                    "\n"
                                    R"({"position_m":[1.3,0.321,0.5]})"
                                    "\n"
                                    R"({"position_m":[1.3,0.321,0.5],"directoin":[1,0,0]})"
                                    "\n"
                                    R"({"position_m":[1.8,0,0.50407],"direction":[1,0,0]})"
                                    "\n"} +
                        kPaperGoal);
  ASSERT_EQ(lines.size(), 10U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(lines[i]["status"], "invalid_input") << i;
    EXPECT_FALSE(lines[i]["reason"].get<std::string>().empty()) << i;
  }
  EXPECT_EQ(lines[8]["status"], "out_of_reach");
  EXPECT_NE(lines[8]["reason"].get<std::string>().find("0.11"), std::string::npos) << lines[8];
  EXPECT_EQ(lines[9]["status"], "ok");
}

TEST(IkCalculator, AKeyThatIsGivenTwiceIsRefusedWithItsName) {
  const auto lines =
      ik(R"({"position_m":[1.3,0.321,0.504],"direction":[1,0,0],"position_m":[1,0,0.5]})"
         "\n"
         R"({"position_m":[1.3,0.321,0.504],"direction":[1,0,0],"seed":{"a":1,"a":2}})"
         "\n");
  EXPECT_EQ(lines[0],
            (json{{"status", "invalid_input"}, {"reason", "'position_m' is given twice"}}));
  EXPECT_EQ(lines[1], (json{{"status", "invalid_input"}, {"reason", "'a' is given twice"}}));
  const auto zero = fk(R"({"joints":[0,0,0,0,0,0],"joints":[1,0,0,0,0,0]})"
                       "\n");
  EXPECT_EQ(zero[0]["reason"], "'joints' is given twice");
}

TEST(IkCalculator, SaysThatARollCannotBeReachedAndNotHowFarAwayItIs) {
  const auto lines = ik(R"({"position_m":[1.3,0.321,0.504],"quaternion_xyzw":[0,0,0,1]})"
                        "\n");
  EXPECT_EQ(lines[0]["status"], "out_of_reach");
  EXPECT_EQ(lines[0]["reason"], "the lamp cannot roll about its pointing axis");
}

TEST(IkCalculator, ANeedlesDepthIsAskedForAndToldInMetres) {
  const std::string goal = R"({"position_m":[0.55,0.15,0.1],"direction":[0,0,-1],)";
  const auto lines =
      answers({armature(), "ik", "--robot", source_file("configs/robots/sr1_needle.yaml"),
               "--plugin", "ik/puma_algebraic"},
              goal + "\"redundancy_m\":0.12}\n" + goal + "\"redundancy_rad\":0.12}\n");
  EXPECT_EQ(lines[0]["status"], "ok");
  ASSERT_EQ(lines[0]["solutions"].size(), 8U);
  for (const json& solution : lines[0]["solutions"]) {
    EXPECT_EQ(solution["redundancy_m"], 0.12);
    EXPECT_EQ(solution["joints"][5], 0.12);
  }
  EXPECT_EQ(lines[1], (json{{"status", "invalid_input"},
                            {"reason", "'redundancy_rad' is 'redundancy_m' for this solver"}}));
}

TEST(IkCalculator, TellsWhereARedundantArmKeepsItsLimits) {
  const auto lines = answers({armature(), "ik", "--robot", source_file("configs/robots/med7.yaml"),
                              "--plugin", "ik/srs_arm_angle"},
                             R"({"position_m":[0.4,0.1,0.5],"quaternion_xyzw":[0,1,0,0]})"
                             "\n");
  EXPECT_EQ(lines[0]["status"], "ok");
  ASSERT_EQ(lines[0]["solutions"].size(), 8U);
  for (const json& solution : lines[0]["solutions"]) {
    const double chosen = solution["redundancy_rad"];
    bool inside = false;
    for (const json& interval : solution["redundancy_intervals_rad"]) {
      inside = inside || (chosen >= interval[0] && chosen <= interval[1]);
    }
    EXPECT_EQ(inside, solution["within_limits"].get<bool>()) << solution;
  }
  EXPECT_FALSE(ik(kPaperGoal)[0]["solutions"][0].contains("redundancy_intervals_rad"));
}

TEST(IkCalculator, RefusesAnUnknownSolverByNameWithExitCodeThree) {
  const auto result =
      run_command({armature(), "ik", "--robot", kLamp, "--plugin", "ik/lamp_geometrc"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("did you mean 'ik/lamp_geometric'"), std::string::npos) << result.err;
}

TEST(FkCalculator, GivesThePapersZeroPose) {
  const auto lines = fk("{\"joints\":[0,0,0,0,0,0]}\n");
  EXPECT_NEAR(lines[0]["position_m"][0].get<double>(), 1.690, 1e-12);
  EXPECT_NEAR(lines[0]["position_m"][2].get<double>(), 0.50407, 1e-12);
  EXPECT_NEAR(lines[0]["direction"][0].get<double>(), 1, 1e-12);
}

TEST(FkCalculator, RefusesJointsThatContradictTheParallelogram) {
  const auto lines = fk("{\"joints\":[0,0,0.5,0.5,0,0]}\n{\"joints\":[0,0,0]}\n");
  EXPECT_EQ(lines[0]["status"], "invalid_input");
  EXPECT_EQ(lines[1]["reason"], "'joints' has 3 numbers, must have 6");
}

const std::string kGantry = source_file("tests/data/urdf/gantry.urdf");

TEST(FkCalculator, TakesAUrdfFileWithATipAndABase) {
  const std::vector<std::string> gripper{armature(), "fk", "--robot", kGantry, "--tip", "gripper"};
  std::vector<std::string> from_bridge = gripper;
  from_bridge.insert(from_bridge.end(), {"--base", "bridge"});
  const auto rail = answers(gripper, "{\"joints\":[0.5,0.1,0.2,0.3,0.4]}\n");
  const auto bridge =
      answers(from_bridge, "{\"joints\":[0.1,0.2,0.3,0.4]}\n{\"joints\":[0.5,0.1,0.2,0.3,0.4]}\n");
  const std::vector<double> rail_to_bridge{0.1 + 0.5, 0, 1.8};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(rail[0]["position_m"][i].get<double>(),
                bridge[0]["position_m"][i].get<double>() + rail_to_bridge[i], 1e-12);
  }
  EXPECT_EQ(bridge[1]["reason"], "'joints' has 5 numbers, must have 4");
}

TEST(FkCalculator, KnowsTheTipOfAUrdfArmAsItsToolToo) {
  const TemporaryFolder folder;
  std::ofstream{folder / "puma_tool.yaml"}
      << "{armature_robot: 1, name: puma, base: foot, tip: tool0, pointing_axis: y, urdf: "
      << source_file("tests/data/urdf/skew_puma.urdf") << "}\n";
  const std::string q = "{\"joints\":[0.2,-1,-1.5,0.3,0.5,0.1]}\n";
  const std::vector<std::string> fk_of{armature(), "fk", "--robot", folder / "puma_tool.yaml"};
  std::vector<std::string> of_tool = fk_of;
  of_tool.insert(of_tool.end(), {"--tip", "tool"});
  const json tip = answers(fk_of, q)[0];
  EXPECT_EQ(tip["direction"].size(), 3U);
  EXPECT_EQ(answers(of_tool, q)[0], tip);
}

TEST(IkCalculator, ServesAUrdfArmThatHasASolversPatternInClosedForm) {
  const std::string file = source_file("tests/data/urdf/skew_puma.urdf");
  const std::vector<double> q{0.2, -1, -1.5, 0.3, 0.5, 0.1};
  const json pose = answers({armature(), "fk", "--robot", file, "--tip", "tool0"},
                            json{{"joints", q}}.dump() + "\n")[0];
  const json answer = answers(
      {armature(), "ik", "--robot", file, "--tip", "tool0", "--plugin", "ik/puma_algebraic"},
      pose.dump() + "\n")[0];
  EXPECT_EQ(answer["status"], "ok");
  ASSERT_EQ(answer["solutions"].size(), 8U);
  double nearest = 1;
  for (const json& solution : answer["solutions"]) {
    double off = 0;
    for (std::size_t i = 0; i < 6; ++i)
      off = std::max(off, std::abs(solution["joints"][i].get<double>() - q[i]));
    nearest = std::min(nearest, off);
  }
  EXPECT_LT(nearest, 1e-12);
}

TEST(Calculator, SaysWhichLinkIsMissingAndWhatABaseIsFor) {
  const auto refused = [](const std::vector<std::string>& more) {
    std::vector<std::string> command{armature(), "fk", "--robot"};
    command.insert(command.end(), more.begin(), more.end());
    const auto result = run_command(command);
    EXPECT_EQ(result.exit_code, 3);
    return result.err;
  };
  EXPECT_EQ(refused({kGantry}),
            "--tip: the link that goals are stated for is missing; links at the ends of " +
                kGantry + ": camera, gripper\n");
  EXPECT_EQ(refused({kGantry, "--tip", "griper"}),
            "--tip: there is no link 'griper' in " + kGantry + "; did you mean 'gripper'?\n");
  EXPECT_EQ(refused({kLamp, "--base", "base"}),
            "armature: --base names a link of a URDF file; where '" + kLamp +
                "' stands is written in it\n");
}

TEST(Calculator, RefusesAnInputThatHasNoLines) {
  const auto asked = [](const std::string& input) {
    return run_command({armature(), "ik", "--robot", kLamp, input});
  };
  const CommandResult folder = asked("/tmp"), gone = asked("/tmp/gone.jsonl"),
                      nothing = asked("/dev/null");
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_EQ(folder.err, "armature: cannot read '/tmp': Is a directory\n");
  EXPECT_EQ(gone.exit_code, 3);
  EXPECT_EQ(gone.err, "armature: cannot read '/tmp/gone.jsonl': No such file or directory\n");
  EXPECT_EQ(nothing.exit_code, 0) << "nothing was asked, and nothing answered";
  EXPECT_EQ(nothing.err, "armature: the input has no lines to answer\n");
  const auto piped =
      run_command({"/bin/sh", "-c", armature() + " fk --robot " + kLamp + " < /tmp"});
  EXPECT_EQ(piped.exit_code, 1);
  EXPECT_EQ(piped.err, "armature: the input cannot be read to its end\n");
}

TEST(Calculator, EndsAtALineThatHasNoEnd) {
  const CommandResult zeros = run_command({armature(), "fk", "--robot", kLamp, "/dev/zero"});
  EXPECT_EQ(zeros.exit_code, 1);
  EXPECT_EQ(zeros.err, "armature: line 1 of the input is longer than 16777216 bytes\n");
}

TEST(IkCalculator, RefusesAQuaternionOrADirectionThatIsNoUnit) {
  const auto reason = [](const std::string& orientation) {
    return ik("{\"position_m\":[1.3,0.321,0.504]," + orientation + "}\n")[0]["reason"];
  };
  EXPECT_EQ(reason(R"("quaternion_xyzw":[0,0,0,2])"), "the goal's quaternion has length 2, not 1");
  EXPECT_EQ(reason(R"("direction":[0,-3,4])"), "the goal's direction has length 5, not 1");
  EXPECT_EQ(reason(R"("direction":[0,0,0])"), "the goal's direction has length 0, not 1");
}

TEST(Calculator, LoadsNeitherDdsNorOpenCvNorDlib) {
  const auto result =
      run_command({armature(), "ik", "--robot", kLamp, "--plugin", "ik/lamp_geometric"},
                  {.environment = {{"LD_DEBUG", "libs"}}, .input = kPaperGoal});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* library : {"libfastrtps", "libopencv", "libdlib"}) {
    EXPECT_EQ(result.err.find(library), std::string::npos) << library;
  }
  EXPECT_NE(result.err.find("ik_lamp_geometric"), std::string::npos);
}

}  // namespace
}  // namespace armature::test
