// SPDX-License-Identifier: Apache-2.0
// `armature plugin verify`: one line per law, and for what breaks one the command that shows it.
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "armature/values/sanitizer.hpp"
#include "tests/command_line/lamp_robot.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kFaulty = std::string{ARMATURE_BINARY_DIR} + "/tests/plugins/ik_faulty.so";

/// A crash is to be one: a sanitizer shall not turn it into a report.
Command::Options crashes_allowed() {
  const auto without_reports = [](const char* options) {
    const char* given = std::getenv(options);
    return std::string{given ? given : ""} + ":handle_segv=0";
  };
  return {.environment = {{"ASAN_OPTIONS", without_reports("ASAN_OPTIONS")},
                          {"TSAN_OPTIONS", without_reports("TSAN_OPTIONS")}},
          .input = {}};
}

CommandResult verify(const std::string& plugin, const std::vector<std::string>& more) {
  std::vector<std::string> command{armature(), "plugin", "verify", plugin};
  command.insert(command.end(), more.begin(), more.end());
  return run_command(command, crashes_allowed(), std::chrono::seconds{200});
}
CommandResult verify_faulty(const std::string& params) {
  return verify(kFaulty, {"--robot", kLamp, "--poses", "20", "--params", params});
}

/// The first "echo ... | armature ik ..." of the output, run by a shell.
CommandResult reproduce(const std::string& out) {
  const auto found = matches_of("echo '[^\n]*", out);
  if (found.empty()) return {.exit_code = -1};
  const std::string command =
      all_replaced(found.front().front(), "armature ik", armature() + " ik");
  return run_command({"/bin/bash", "-c", "set -o pipefail; " + command}, crashes_allowed());
}

TEST(PluginVerify, PrintsALinePerLawAndEndsWithZeroWhenAllAreKept) {
  const auto result = verify("ik/lamp_geometric", {"--robot", kLamp, "--poses", "50"});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  std::istringstream lines{result.out};
  int laws = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  pass  ") || line.starts_with("  skip  ")) ++laws;
  }
  EXPECT_EQ(laws, 18) << result.out;
  EXPECT_THAT(result.out, HasSubstr("  pass  fk(ik(goal)) = goal"));
  EXPECT_THAT(result.out, HasSubstr("  skip  an asked arm angle is kept"));
  EXPECT_THAT(result.out, HasSubstr("  skip  told arm angles are those within limits"));
  EXPECT_THAT(result.out, HasSubstr("the arm is not redundant"));
  EXPECT_THAT(result.out, testing::ContainsRegex(kSanitized ? "skip  solving does not allocate"
                                                            : "pass  solving does not allocate"));
}

TEST(PluginVerify, TriesEveryRobotThatCameWithItWhenNoneIsNamed) {
  const auto result = verify("ik/lamp_geometric", {"--poses", "5", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json all = json::parse(result.out);
  EXPECT_EQ(all["ok"], true);
  int served = 0;
  for (const json& robot : all["robots"]) {
    if (robot["refused"] == "") ++served;
    EXPECT_EQ(robot["laws"].empty(), robot["refused"] != "") << robot;
  }
  EXPECT_EQ(served, 1);
}

TEST(PluginVerify, ShowsTheQuestionThatBreaksALaw) {
  const auto result = verify_faulty("{fault: residual}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("  FAIL  fk(ik(goal)) = goal"));
  EXPECT_THAT(result.out, HasSubstr("tells a residual of 0.5 m"));
  const auto again = reproduce(result.out);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("\"residual_m\":0.5"));
}

TEST(PluginVerify, SurvivesASolverThatCrashesAndShowsWhatItWasAsked) {
  const auto result = verify_faulty("{fault: crash}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("killed by signal 11"));
  EXPECT_THAT(result.out, HasSubstr("loading leaves nothing behind"));  // the last law is reached
  EXPECT_EQ(reproduce(result.out).exit_code, 128 + 11) << result.out;
}

TEST(PluginVerify, ShowsTheDepthThatANeedleCrashesAtInMetres) {
  const auto result = verify(kFaulty, {"--robot", source_file("configs/robots/sr1_needle.yaml"),
                                       "--poses", "5", "--params", "{fault: crash_at_depth}"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("\"redundancy_m\":0.125,"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("redundancy_rad")));
  EXPECT_EQ(reproduce(result.out).exit_code, 128 + 11) << result.out;
}

TEST(PluginVerify, EndsALawThatHangsWithALineThatNamesIt) {
  const auto result = verify(
      kFaulty, {"--robot", kLamp, "--poses", "5", "--timeout", "1", "--params", "{fault: hang}"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_FALSE(result.timed_out);
  EXPECT_THAT(result.out, testing::ContainsRegex("  FAIL  fk.ik.goal.. = goal +[0-9.]+ s"));
  EXPECT_THAT(result.out,
              HasSubstr("          not done after 1 s\n          echo '{\"position_m\":["));
  EXPECT_THAT(result.out, HasSubstr("loading leaves nothing behind"));  // the last law is reached
}

TEST(PluginVerify, CountsWhatAnUnloadedLibraryLeavesBehind) {
  if (kSanitized) GTEST_SKIP() << "memory is not counted under a sanitizer";
  const auto result = verify_faulty("{fault: leak}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, testing::ContainsRegex("[0-9]+ bytes of heap.* more after 100 cycles"));
}

TEST(PluginVerify, HoldsAPluginToWhatItOffersWithItsParameters) {
  EXPECT_EQ(verify_faulty("{}").exit_code, 0);
  const auto result = verify_faulty("{promises: true}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("  FAIL  what is within limits is reached"));
}

TEST(PluginVerify, ARobotThatIsNotServedIsSaidAndNothingIsVerified) {
  const auto result = verify_faulty("{fault: refuse}");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("not served: it serves no robot at all"));
  EXPECT_THAT(result.err, HasSubstr("ik/faulty serves none of these robots"));
}

TEST(PluginVerify, EveryKindHasLaws) {
  for (const std::string plugin :
       {"path/mouth_arc", "select/nearest", "trajectory/quintic_spline", "registration/rigid",
        "markers/spheres", "target/constant_velocity", "face_pose/three_point",
        "landmarks/dlib68"}) {
    const auto result = verify(plugin, {"--robot", kLamp, "--json"});
    ASSERT_EQ(result.exit_code, 0) << plugin << "\n" << result.out << result.err;
    const json laws = json::parse(result.out)["robots"][0]["laws"];
    EXPECT_GE(laws.size(), 3u) << plugin;
    const bool sees = plugin.starts_with("landmarks/");
    for (const json& law : laws) {
      EXPECT_NE(law["result"], "fail") << plugin << law;
      if (sees) {
        EXPECT_EQ(law["result"], "pass") << "a drawn face is there for " << plugin << law;
      }
    }
  }
}

TEST(PluginVerify, ALibraryWhoseWorkAnotherOneDoesOnThisProcessorIsItsPlugin) {
  const std::string library =
      std::string{ARMATURE_BINARY_DIR} + "/lib/armature/plugins/detector_hog.so";
  const auto result = verify(library, {"--json"});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  const json told = json::parse(result.out);
  EXPECT_EQ(told["plugin"], "detector/hog");
  EXPECT_GE(told["robots"][0]["laws"].size(), 3u);
  for (const json& law : told["robots"][0]["laws"]) {
    EXPECT_EQ(law["result"], "pass") << "a drawn face is there for it " << law;
  }
}

TEST(PluginVerify, AComponentIsFedSilenceNanAndMessagesByChance) {
  const auto result = verify("arm/simulated", {"--robot", kLamp, "--poses", "50"});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("  pass  silence is no fault"));
  EXPECT_THAT(result.out, HasSubstr("  pass  messages full of NaN are no fault"));
}

TEST(PluginVerify, NamesWhatIsWrongOnTheCommandLine) {
  const auto unknown = verify("ik/lamp_geometrc", {"--robot", kLamp});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'ik/lamp_geometric'"));
  const auto tip = verify("ik/numeric", {"--robot", kLamp, "--tip", "tol"});
  EXPECT_EQ(tip.exit_code, 3);
  EXPECT_THAT(tip.err, HasSubstr("robot 'dental_lamp' has no frame 'tol'; did you mean 'tool'?"));
  const auto params = verify("ik/numeric", {"--robot", kLamp, "--params", "{restarts: 3}"});
  EXPECT_EQ(params.exit_code, 3);
  EXPECT_THAT(params.err, HasSubstr("restarts"));
}

}  // namespace
}  // namespace armature::test
