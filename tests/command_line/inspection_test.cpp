// SPDX-License-Identifier: Apache-2.0
// `armature check`, `show`, `graph` and `plugin` tell what a deployment and a plugin are.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command.hpp"

namespace armature::test {
namespace {

const std::string kLampDeployment = source_file("configs/dental_lamp.yaml");

TEST(Check, CountsWhatItFoundSound) {
  const auto result = run_command({armature(), "check", kLampDeployment});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("dental_lamp: ok, 9 components, ", 0), 0U) << result.out;
}

TEST(Check, FindsTheExampleOfTheDocumentationSound) {
  std::ostringstream page;
  page << std::ifstream{source_file("docs/deployment_file.md")}.rdbuf();
  const std::string text = page.str(), fence = "```yaml\n";
  const auto from = text.find(fence);
  ASSERT_NE(from, std::string::npos);
  const auto example =
      text.substr(from + fence.size(), text.find("```", from + fence.size()) - from - fence.size());
  const auto folder =
      std::filesystem::temp_directory_path() / ("armature-example-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const char* beside : {"robots", "rigs"}) {
    std::filesystem::create_symlink(source_file(std::string{"configs/"} + beside), folder / beside);
  }
  std::ofstream{folder / "example.yaml"} << example;
  const auto result = run_command({armature(), "check", folder / "example.yaml"});
  std::filesystem::remove_all(folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

TEST(Check, SaysNothingOfAFileThatIsNoDeployment) {
  const auto file =
      std::filesystem::temp_directory_path() / ("armature-other-" + std::to_string(getpid()));
  for (const std::string text : {"root:$y$secret:19000:0:99999:7:::\n", "secret: {secret: 1}\n"}) {
    std::ofstream{file} << text;
    for (const char* verb : {"check", "show", "graph", "run"}) {
      const auto result = run_command({armature(), verb, file});
      EXPECT_EQ(result.exit_code, 3) << verb;
      EXPECT_THAT(result.out + result.err, testing::Not(testing::HasSubstr("secret"))) << verb;
    }
  }
  std::filesystem::remove(file);
}

TEST(Check, LetsAComponentThatMayUseARigUseNone) {
  const auto result =
      run_command({armature(), "check", kLampDeployment, "--set", "components.monitor.rig=none"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Check, FindsAnArmThatIsBoundToTheOtherRobot) {
  const auto result =
      run_command({armature(), "check", source_file("configs/master_manipulator.yaml"), "--set",
                   "components.arm.robot=master"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("arm.servo_jp reads values of robot 'master' from topic "
                            "'/master_manipulator/arm/servo_jp', but motion.servo_jp writes values "
                            "of robot 'slave'"),
            std::string::npos)
      << result.err;
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

TEST(PluginInfo, ShowsWhatAPluginNeedsOffersAndMeasures) {
  const auto info = [](const std::string& id) {
    return run_command({armature(), "plugin", "info", id}).out;
  };
  EXPECT_THAT(info("path/mouth_points"),
              testing::HasSubstr("needs:\n  time_law                   Each of the moves lasts "
                                 "segment_s (unless 'segment_s' is 0)\n"));
  EXPECT_THAT(info("trajectory/quintic"), testing::HasSubstr("offers:\n  time_law   "));
  EXPECT_THAT(info("report/implant"), testing::HasSubstr(" (that of task/implant)\n"));
  EXPECT_THAT(info("report/lamp_alignment"), testing::HasSubstr("measures:\n  time_to_find_s   "));

  const auto result =
      run_command({armature(), "plugin", "info", "report/lamp_alignment", "--json"});
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["needs"][0]["name"], "patient_moves");
  EXPECT_EQ(told["needs"][0]["when"], "expect_move");
  EXPECT_TRUE(told["measures"].contains("distance_error_mm"));
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
