// SPDX-License-Identifier: Apache-2.0
// What `armature check`, `show` and `plugin` say to programs, beside what they say to people.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

/// A verb with `--json` and what it printed; it has to print nothing else.
json told(const std::vector<std::string>& arguments, int exit_code) {
  std::vector<std::string> command{armature()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.push_back("--json");
  const auto result = run_command(command);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_EQ(result.err, "");
  const json read = json::parse(result.out, nullptr, false);
  EXPECT_FALSE(read.is_discarded()) << result.out;
  return read;
}

const std::string kLampFile = source_file("configs/dental_lamp.yaml");

TEST(CheckAsJson, OfASoundDeploymentIsOk) {
  const json lamp = told({"check", kLampFile}, 0);
  EXPECT_EQ(lamp["ok"], true);
  EXPECT_EQ(lamp["deployment"], "dental_lamp");
  EXPECT_EQ(lamp["components"], 11);
  EXPECT_EQ(lamp["problems"], json::array());
  EXPECT_EQ(lamp["warnings"], json::array());
}

TEST(CheckAsJson, GivesEveryProblemItsPlaceAndTheNearestWordApart) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "deployment.yaml";
  std::ofstream{file} << "armature: 1\nname: x\nclokc: system\n";
  const json problems = told({"check", file}, 3)["problems"];
  EXPECT_THAT(problems, testing::Contains(json{{"file", file.string()},
                                               {"line", 3},
                                               {"column", 1},
                                               {"text", "unknown key 'clokc' in the deployment"},
                                               {"hint", "did you mean 'clock'?"}}));
  EXPECT_GT(problems.size(), 1U) << "all that is wrong, not the first alone";
}

TEST(CheckAsJson, OfAnAssignmentNamesItAndNoLine) {
  const json check =
      told({"check", kLampFile, "--set", "components.motion.ik.plugin=ik/numerc"}, 3);
  EXPECT_EQ(check["ok"], false);
  ASSERT_EQ(check["problems"].size(), 1U);
  const json& problem = check["problems"][0];
  EXPECT_EQ(problem["file"], "--set components.motion.ik.plugin=ik/numerc");
  EXPECT_FALSE(problem.contains("line"));
  EXPECT_EQ(problem["text"], "unknown plugin 'ik/numerc'");
  EXPECT_THAT(problem["hint"].get<std::string>(),
              testing::StartsWith("did you mean 'ik/numeric'?"));
}

TEST(CheckAsJson, OfANameThatIsNoFileSaysSo) {
  const json problem = told({"check", "dental_lmp"}, 3)["problems"][0];
  EXPECT_EQ(
      problem["text"],
      "there is no file 'dental_lmp' here, and no deployment 'dental_lmp' came with armature");
  EXPECT_THAT(problem["hint"].get<std::string>(),
              testing::StartsWith("did you mean 'dental_lamp'"));
}

TEST(CheckAsJson, LooksForAHintBehindWhatIsQuoted) {
  const std::string id = "ik/it's; known: a; did you mean b";
  const json problem = told(
      {"check", kLampFile, "--set", "components.motion.ik.plugin=\"" + id + '"'}, 3)["problems"][0];
  EXPECT_EQ(problem["text"], "unknown plugin '" + id + "'");
}

TEST(CheckAsJson, HasTheWarningsThatPeopleRead) {
  const json check = told({"check", kLampFile, "--set", "components.arm.executor=monitor"}, 0);
  EXPECT_EQ(check["ok"], true);
  ASSERT_EQ(check["warnings"].size(), 1U);
  EXPECT_THAT(check["warnings"][0].get<std::string>(),
              testing::StartsWith("component 'arm' moves an arm and shares the executor"));
}

TEST(CheckAsJson, HasWhatComponentsNote) {
  const json notes = told({"check", kLampFile}, 0)["notes"];
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0]["component"], "task");
  EXPECT_THAT(notes[0]["text"].get<std::string>(), testing::StartsWith("the search sees 48 % "));
}

TEST(CheckAsJson, SaysWhatWasNotTriedAsItWouldRunAProgram) {
  const json check = told({"check", kLampFile, "--set",
                           "components.motion.ik={plugin: ik/process, params: {command: [none]}}"},
                          0);
  EXPECT_THAT(check["not_tried"],
              testing::Contains(json{{"component", "motion"}, {"runs_program", "ik/process"}}));
}

TEST(ShowAsJson, GivesEveryValueItsTypeAndItsOrigin) {
  const json lamp = told({"show", kLampFile, "--set", "components.task.params.settle_frames=7"}, 0);
  EXPECT_EQ(lamp["clock"]["value"], "system");
  EXPECT_EQ(lamp["clock"]["origin"]["file"], kLampFile);
  EXPECT_GT(lamp["clock"]["origin"]["line"], 1);
  EXPECT_GT(lamp["clock"]["origin"]["column"], 1);
  const json& task = lamp["components"]["task"]["params"];
  EXPECT_EQ(task["distance_m"]["value"], 0.5);
  EXPECT_EQ(task["settle_frames"]["value"].dump(), "7") << "a number, not a text";
  EXPECT_EQ(task["settle_frames"]["origin"],
            (json{{"file", "--set components.task.params.settle_frames=7"}}));
}

TEST(ShowAsJson, HasTheDefaultsOfPluginsAndListsOfThem) {
  const json lamp = told({"show", kLampFile}, 0);
  const json& task = lamp["components"]["task"]["params"];
  EXPECT_EQ(task["lost_s"]["origin"]["file"], "default of task/lamp_alignment");
  ASSERT_TRUE(task["search_yaw_deg"].is_array()) << task;
  EXPECT_EQ(task["search_yaw_deg"][2]["value"], -40);
  EXPECT_EQ(lamp["components"]["motion"]["path"]["params"]["step_deg"]["value"], 0.5) << "a slot";
}

TEST(ShowAsJson, ATextInQuotesStaysAText) {
  const json lamp = told({"show", kLampFile, "--set", "name='007'", "--set", "seed=9"}, 0);
  EXPECT_EQ(lamp["name"]["value"], "007");
  EXPECT_EQ(lamp["seed"]["value"], 9);
}

TEST(ShowAsJson, OfNoDeploymentPrintsNothingAndEndsAsWithoutIt) {
  const auto result =
      run_command({armature(), "show", source_file("configs/robots/dental_lamp.yaml"), "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, testing::HasSubstr("not a deployment but a robot file"));
}

TEST(PluginListAsJson, HasTheManifestOfEveryPlugin) {
  const json list = told({"plugin", "list"}, 0);
  EXPECT_EQ(list["unusable"], json::array());
  const json& plugins = list["plugins"];
  const auto numeric = std::find_if(plugins.begin(), plugins.end(), [](const json& plugin) {
    return plugin["id"] == "ik/numeric";
  });
  ASSERT_NE(numeric, plugins.end());
  json info = told({"plugin", "info", "ik/numeric"}, 0);
  info.erase("alone");
  EXPECT_EQ(*numeric, info) << "the same manifest as `plugin info` prints";
}

TEST(PluginInfoAsJson, GivesEveryDefaultItsType) {
  std::map<std::string, json> defaults;
  const json tracker = told({"plugin", "info", "sim/optical_tracker"}, 0);
  for (const json& param : tracker["params"]) {
    defaults[param["name"]] = param.value("default", json{});
  }
  EXPECT_EQ(defaults["jaw_hidden_s"], json::array());
  EXPECT_EQ(defaults["rate_hz"], 60) << "a number, not a text";
}

}  // namespace
}  // namespace armature::test
