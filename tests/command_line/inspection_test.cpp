// SPDX-License-Identifier: Apache-2.0
// `armature check`, `show`, `graph` and `plugin` tell what a deployment and a plugin are.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "armature/values/file_content.hpp"
#include "armature/values/sanitizer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

const std::string kLampDeployment = source_file("configs/dental_lamp.yaml");

TEST(Check, CountsWhatItFoundSound) {
  const auto result = run_command({armature(), "check", kLampDeployment});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("dental_lamp: ok, 11 components, ", 0), 0U) << result.out;
}

TEST(Check, TellsWhatPartOfItsPromiseTheSearchOfTheLampSees) {
  const auto result = run_command({armature(), "check", kLampDeployment});
  EXPECT_NE(
      result.out.find("\ntask: the search sees 48 % of the faces that it promises: mouths at "),
      std::string::npos)
      << result.out;
  const auto without_cameras =
      run_command({armature(), "check", kLampDeployment, "--set", "components.task.rig=none"});
  EXPECT_EQ(without_cameras.exit_code, 0) << without_cameras.err;
  EXPECT_EQ(without_cameras.out.find("\ntask: "), std::string::npos) << without_cameras.out;
}

TEST(Check, FindsTheExampleOfTheDocumentationSound) {
  const std::string text = content_of(source_file("docs/deployment_file.md")), fence = "```yaml\n";
  const auto from = text.find(fence);
  ASSERT_NE(from, std::string::npos);
  const auto example =
      text.substr(from + fence.size(), text.find("```", from + fence.size()) - from - fence.size());
  const TemporaryFolder folder;
  for (const char* beside : {"robots", "rigs"}) {
    std::filesystem::create_symlink(source_file(std::string{"configs/"} + beside), folder / beside);
  }
  std::ofstream{folder / "example.yaml"} << example;
  const auto result = run_command({armature(), "check", folder / "example.yaml"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

TEST(Check, SaysNothingOfAFileThatIsNoDeployment) {
  const TemporaryFolder folder;
  const auto file = folder / "other";
  for (const std::string text : {"root:$y$secret:19000:0:99999:7:::\n", "secret: {secret: 1}\n"}) {
    std::ofstream{file} << text;
    for (const char* verb : {"check", "show", "graph", "run"}) {
      const auto result = run_command({armature(), verb, file});
      EXPECT_EQ(result.exit_code, 3) << verb;
      EXPECT_THAT(result.out + result.err, testing::Not(testing::HasSubstr("secret"))) << verb;
    }
  }
}

TEST(Check, LetsAComponentThatMayUseARigUseNone) {
  const auto result =
      run_command({armature(), "check", kLampDeployment, "--set", "components.monitor.rig=none"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Check, FindsAnArmThatIsBoundToTheOtherRobot) {
  const auto result =
      run_command({armature(), "check", source_file("configs/master_manipulator.yaml"), "--set",
                   "components.arm.robot=leader"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("arm.servo_jp reads values of robot 'leader' from topic "
                            "'/master_manipulator/arm/servo_jp', but motion.servo_jp writes values "
                            "of robot 'follower'"),
            std::string::npos)
      << result.err;
}

TEST(Check, TellsTheWarningsOfAFaultyFile) {
  const auto result = run_command(
      {armature(), "check", kLampDeployment, "--set", "components.scene.plugin=sim/nosuch"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, testing::ContainsRegex("warning: .*components.scene"));
  EXPECT_THAT(result.err, testing::HasSubstr("unknown plugin 'sim/nosuch'"));
}

TEST(Check, AsksWhichOfTwoRigsOrNone) {
  const auto result =
      run_command({armature(), "check", kLampDeployment, "--set",
                   "rigs.hand=" + source_file("configs/rigs/default.yaml"), "--set",
                   "components.scene.rig=head", "--set", "components.target.rig=head"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("component 'monitor' must say which rig: 'rig: ...', or 'rig: none'"),
            std::string::npos)
      << result.err;
}

TEST(Show, GivesEveryValueItsOrigin) {
  const auto result = run_command(
      {armature(), "show", kLampDeployment, "--set", "components.motion.ik.plugin=ik/numeric"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("ik/numeric"), std::string::npos);
  EXPECT_NE(result.out.find("--set components.motion.ik.plugin=ik/numeric"), std::string::npos);
  EXPECT_NE(result.out.find("dental_lamp.yaml:"), std::string::npos);
}

TEST(Show, ListsTheDefaultsOfEveryPluginWithTheirOrigin) {
  const auto result = run_command(
      {armature(), "show", kLampDeployment, "--set", "components.task.params.settle_frames=7"});
  EXPECT_THAT(result.out, testing::ContainsRegex("lost_s: 2 +# default of task/lamp_alignment\n"));
  EXPECT_THAT(result.out,
              testing::ContainsRegex("search_yaw_deg: \\[40, 0, -40\\] +# default of "));
  EXPECT_THAT(result.out, testing::ContainsRegex("step_deg: 0.5 +# default of path/mouth_arc\n"))
      << "in a slot";
  EXPECT_THAT(result.out, testing::ContainsRegex("settle_frames: 7 +# --set "));
}

const std::string kBiopsyDeployment = source_file("configs/sr1_biopsy.yaml");

using Row = std::vector<std::string>;

/// The lines of the table that `armature show` ends with, each as its cells; the first is its head.
std::vector<Row> leases_of(const std::string& file, const std::vector<std::string>& settings) {
  std::vector<std::string> command{armature(), "show", file};
  for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
  const CommandResult result = run_command(command);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto begin = result.out.find("# who waits ");
  std::istringstream lines{begin == std::string::npos ? "" : result.out.substr(begin)};
  std::vector<Row> rows;
  std::vector<std::size_t> columns;
  for (std::string line; std::getline(lines, line);) {
    if (columns.empty()) {
      for (const char* head : {"who waits", "for whom", "at most", "and then"}) {
        columns.push_back(line.find(head));
      }
    }
    Row& row = rows.emplace_back();
    EXPECT_EQ(line.rfind("# ", 0), 0U) << line;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool last = i + 1 == columns.size();
      std::string cell =
          line.substr(columns[i], last ? std::string::npos : columns[i + 1] - columns[i]);
      cell.erase(cell.find_last_not_of(' ') + 1);
      row.push_back(cell);
    }
  }
  return rows;
}

const std::string kRampsToRest =
    "the arm ramps to rest by itself, and follows again when a command comes";

TEST(Show, TellsWhoWaitsForWhomHowLongAndWhatHappensThen) {
  const auto rows = leases_of(kBiopsyDeployment, {"components.arm.params.command_timeout_s=0.25"});
  EXPECT_THAT(
      rows, testing::IsSupersetOf({
                Row{"who waits", "for whom", "at most", "and then"},
                Row{"motion", "arm measured_js", "0.5 s", "the goals fail and the reference stops"},
                Row{"arm", "motion servo_jp", "0.25 s", kRampsToRest},
            }));
  const auto waits_at = [](const char* what) {
    return testing::Contains(
        testing::ElementsAre(testing::_, testing::HasSubstr(what), testing::_, testing::_));
  };
  EXPECT_THAT(rows, testing::Not(waits_at("hold_to_run"))) << "which nobody writes";
  EXPECT_THAT(rows, testing::Not(waits_at("of process"))) << "there is one only";
}

TEST(Show, TellsWhatFollowsWhenSamplesAreTooOld) {
  const std::string held = "the follower stops, until the clutch is opened and closed again";
  const auto rows =
      leases_of(source_file("configs/master_manipulator.yaml"), {"open=[task.follower_cp]"});
  EXPECT_THAT(rows, testing::IsSupersetOf({
                        Row{"task", "leader measured_cp", "0.1 s", held},
                        Row{"task", "arm measured_cp, programs outside", "0.1 s", held},
                        Row{"task", "surgeon clutch", "0.1 s", held},
                        Row{"leader", "surgeon hand_js", "0.1 s",
                            "the hand has let go, and servo_jp counts again"},
                    }));
}

TEST(Show, TellsWhatTheRuntimeWaitsFor) {
  const std::string goes_on = "it is shown as stalled, and the run goes on";
  const std::string waits = "it is told, and the run waits for the step";
  const auto in_seconds = [](double s) { return fmt::format("{:g} s", kSanitized ? 5 * s : s); };
  EXPECT_THAT(
      leases_of(kBiopsyDeployment, {"clock=system", "components.arm.process=driver"}),
      testing::IsSupersetOf({
          Row{"arm", "motion servo_jp", "0.1 s", kRampsToRest},
          Row{"arm", "motion servo_jp of process main", "0.5 s",
              "it is told, and the run counts as failed: status fault"},
          Row{"watchdog", "a step of motion", in_seconds(0.5), "the run stops"},
          Row{"watchdog", "a step of motion.planner", in_seconds(60), "the run stops"},
          Row{"watchdog", "a step of task", in_seconds(2) + " or 3 periods", "the run stops"},
          Row{"watchdog", "a step of monitor", in_seconds(2) + " or 3 periods", goes_on},
      }));
  EXPECT_THAT(leases_of(kBiopsyDeployment, {}),
              testing::IsSupersetOf({
                  Row{"watchdog", "a step of motion", in_seconds(20), waits},
                  Row{"watchdog", "a step of motion.planner", in_seconds(600), waits},
              }))
      << "in lockstep how fast time goes is the machine's affair";
}

/// A file with this text where no robots and rigs are.
std::string file_in(const TemporaryFolder& folder, const std::string& text) {
  const auto file = folder / "shown.yaml";
  std::ofstream{file} << text;
  return file;
}

TEST(Show, PrintsAFileThatIsTheSameDeployment) {
  const auto shown = run_command({armature(), "show", kBiopsyDeployment});
  ASSERT_THAT(shown.out, testing::HasSubstr("# who waits"));
  const TemporaryFolder elsewhere;
  const auto file = file_in(elsewhere, shown.out);
  const auto again = run_command({armature(), "check", file});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(leases_of(file, {}), leases_of(kBiopsyDeployment, {}));
}

TEST(Show, OfAFaultyFileSaysThatWhoWaitsForWhomIsNotTold) {
  const auto shown = run_command({armature(), "show", kBiopsyDeployment, "--set", "nosuch=1"});
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_THAT(shown.out, testing::HasSubstr("\n# who waits for whom is not told: armature check "
                                            "names what is wrong, 1 in all\n"));
}

TEST(Show, NamesFilesSuchThatTheDeploymentCanBeRunFromAnyFolder) {
  const auto from_here = [](const std::string& file) {
    return std::filesystem::relative(source_file(file)).string();
  };
  // Of the file itself, of the command line, and of parameters of a component and of a slot.
  const auto shown = run_command(
      {armature(), "show", from_here("configs/dental_lamp.yaml"), "--set",
       "rigs.head=" + from_here("configs/rigs/default.yaml"), "--set",
       "components.landmarks.params.model=model.dat", "--set",
       "components.motion.ik={plugin: ik/process, params: {command: [solver], folder: there}}"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  const std::string here = std::filesystem::current_path().string();
  EXPECT_THAT(shown.out, testing::HasSubstr(" arm: " + source_file("configs/robots/")));
  EXPECT_THAT(shown.out, testing::HasSubstr(" head: " + source_file("configs/rigs/default.yaml")));
  EXPECT_THAT(shown.out, testing::HasSubstr(" model: " + here + "/model.dat "));
  EXPECT_THAT(shown.out, testing::HasSubstr(" folder: " + here + "/there "));
  EXPECT_THAT(shown.out, testing::HasSubstr("[solver]")) << "which is no file";
}

TEST(Show, WhatItPrintedRunsInAnotherFolder) {
  const TemporaryFolder elsewhere;
  const auto file = file_in(elsewhere, run_command({armature(), "show", kBiopsyDeployment}).out);
  const auto result = run_command({armature(), "run", file, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Graph, NamesTheWriterAndTheReadersOfATopic) {
  const auto result = run_command({armature(), "graph", kLampDeployment, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto topic = nlohmann::json::parse(result.out)["/dental_lamp/arm/servo_jp"];
  EXPECT_EQ(topic["writers"], (std::vector<std::string>{"motion"}));
  EXPECT_EQ(topic["readers"], (std::vector<std::string>{"arm"}));
}

TEST(Graph, NamesTheTopicsThatRosToolsLookFor) {
  const auto result = run_command({armature(), "graph", kLampDeployment, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto topics = nlohmann::json::parse(result.out);
  EXPECT_EQ(topics["/tf"]["type"], "tf2_msgs/TFMessage");
  EXPECT_EQ(topics["/tf_static"]["type"], "tf2_msgs/TFMessage");
  EXPECT_EQ(topics["/dental_lamp/markers"]["type"], "visualization_msgs/MarkerArray");
  EXPECT_EQ(topics["/dental_lamp/tool_pose"]["type"], "geometry_msgs/PoseStamped");
}

TEST(PluginInfo, ShowsParametersAndPortsFromTheManifest) {
  const auto result = run_command({armature(), "plugin", "info", "sim/photo_scene", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["kind"], "component");
  EXPECT_FALSE(told["params"].empty());
  EXPECT_FALSE(told["out"].empty());
}

TEST(PluginInfo, ShowsWhatAPluginRequiresProvidesAndMeasures) {
  const auto info = [](const std::string& id) {
    return run_command({armature(), "plugin", "info", id}).out;
  };
  EXPECT_THAT(info("path/mouth_points"),
              testing::HasSubstr("requires:\n  time_law                   Each of the moves lasts "
                                 "segment_s (unless 'segment_s' is 0)\n"));
  EXPECT_THAT(info("trajectory/quintic"), testing::HasSubstr("provides:\n  time_law   "));
  EXPECT_THAT(info("report/implant"), testing::HasSubstr(" (that of task/implant)\n"));
  EXPECT_THAT(info("report/lamp_alignment"), testing::HasSubstr("measures:\n  time_to_find_s   "));

  const auto result =
      run_command({armature(), "plugin", "info", "report/lamp_alignment", "--json"});
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["requires"][0]["name"], "patient_moves");
  EXPECT_EQ(told["requires"][0]["when"], "expect_move");
  EXPECT_TRUE(told["measures"].contains("distance_error_mm"));
}

TEST(PluginInfo, ShowsForHowLongAnInputMayBeSilent) {
  EXPECT_THAT(run_command({armature(), "plugin", "info", "arm/simulated"}).out,
              testing::HasSubstr(" (silent for command_timeout_s: " + kRampsToRest + ")\n"));
  const auto ports_of = [](const char* id) {
    return nlohmann::json::parse(
        run_command({armature(), "plugin", "info", id, "--json"}).out)["in"];
  };
  EXPECT_EQ(ports_of("arm/simulated")[1]["lease"]["after"], "command_timeout_s");
  const auto console = ports_of("task/teleoperation");
  EXPECT_FALSE(console[0].contains("lease"));
  EXPECT_EQ(console[1]["lease"]["after"], 0.1);
}

TEST(PluginInfo, OfAPurePluginShowsWhatItHasWhenItRunsAlone) {
  const auto info = [](std::vector<std::string> more) {
    std::vector<std::string> command{armature(), "plugin", "info", "target/constant_velocity"};
    command.insert(command.end(), more.begin(), more.end());
    return run_command(command).out;
  };
  EXPECT_THAT(info({}), testing::HasSubstr("\nalone, directly under components:, it also has\n"
                                           "params:\n  history_s "));
  const auto told = nlohmann::json::parse(info({"--json"}));
  EXPECT_EQ(told["alone"]["params"][0]["name"], "history_s");
  EXPECT_EQ(told["alone"]["out"][0]["name"], "target");
}

TEST(PluginInfo, OfAnUnknownOneNamesTheNearest) {
  const auto result = run_command({armature(), "plugin", "info", "ik/numerc"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("did you mean 'ik/numeric'"), std::string::npos) << result.err;
}

TEST(Check, ReadsAPathGivenBySetFromWhereTheUserStands) {
  const auto result = run_command(
      {armature(), "check", kLampDeployment, "--set",
       "robots.arm=" +
           std::filesystem::relative(source_file("configs/robots/dental_lamp.yaml")).string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Run, RefusesAProcessThatTheDeploymentDoesNotHave) {
  const auto result = run_command({armature(), "run", kLampDeployment, "--process", "visoin"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "armature: deployment 'dental_lamp' has no process 'visoin'; known: main\n");
}

TEST(CommandLine, EndsWithTwoWhenItIsNotUnderstood) {
  EXPECT_EQ(run_command({armature(), "rnu", kLampDeployment}).exit_code, 2);
  EXPECT_EQ(run_command({armature(), "run"}).exit_code, 2);
  EXPECT_EQ(run_command({armature(), "--help"}).exit_code, 0);
}

}  // namespace
}  // namespace armature::test
