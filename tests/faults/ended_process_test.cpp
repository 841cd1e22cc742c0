// SPDX-License-Identifier: Apache-2.0
// A plugin that calls exit(0): the process ends there, and neither its exit code nor what is told
// says that all is well.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

class EndedProcess : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream{file_} << "armature: 1\n"
                            "name: ended\n"
                            "executors: {control: {}, monitor: {}}\n"
                            "components:\n"
                            "  source: {plugin: test/breaker}\n"
                            "  arm: {plugin: test/driver, executor: control}\n"
                            "  monitor: {plugin: test/breaker, topics: monitor, executor: "
                            "monitor}\n";
  }

  CommandResult with(std::vector<std::string> words, const std::string& breaks) const {
    words.insert(words.begin(), armature());
    words.insert(words.end(),
                 {file_.string(), "--set", "components.monitor.params.breaks=" + breaks, "--set",
                  "run.time_limit_s=3"});
    return run_command(words, options_);
  }
  CommandResult run(const std::string& breaks, const std::string& process = "main") const {
    return with({"run", "--json", "--domain", std::to_string(domain_), "--set",
                 "components.monitor.process=" + process},
                breaks);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "ended.yaml";
  int domain_ = unique_dds_domain();
  Command::Options options_{.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}};
};

const std::string kEndedInStep = "component 'monitor' ended the process (exit code 0) in its step";
const std::string kEndedInConstructor =
    "component 'monitor' ended the process (exit code 0) in its constructor";

TEST_F(EndedProcess, ByAStepIsAFaultThatNamesTheComponent) {
  const CommandResult result = run("exits");
  EXPECT_EQ(result.exit_code, 1);
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_EQ(told["reason"], kEndedInStep);
  EXPECT_THAT(result.err, testing::HasSubstr("armature: " + kEndedInStep + "\n"));
}

TEST_F(EndedProcess, QuicklyIsTheSame) {
  const CommandResult result = run("exits_quickly");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(result.out)["reason"],
            "component 'monitor' ended the process (quick_exit()) in its step");
}

TEST_F(EndedProcess, NoneBeginsBeforeItIsMadeAndAConstructorThatTakesLongIsNamed) {
  const CommandResult result = run("takes_long_to_make");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              testing::HasSubstr("component 'monitor' has been in its constructor for 5 s"));
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("component 'arm' has been")));
}

TEST_F(EndedProcess, ByAStepInAnotherProcessIsToldByTheMainOne) {
  const CommandResult result = run("exits", "aside");
  EXPECT_EQ(result.exit_code, 1);
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_EQ(told["reason"], "process 'aside': " + kEndedInStep);
}

TEST_F(EndedProcess, ByAConstructorFailsTheRunAndTheCheck) {
  const CommandResult ran = run("exits_when_made");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(ran.out)["reason"], kEndedInConstructor);
  const CommandResult checked = with({"check"}, "exits_when_made");
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_EQ(checked.err, "armature: " + kEndedInConstructor + "\n");
  const CommandResult as_json = with({"check", "--json"}, "exits_when_made");
  EXPECT_EQ(as_json.exit_code, 1);
  const auto problems = nlohmann::json::parse(as_json.out)["problems"];
  EXPECT_EQ(problems, nlohmann::json::array({{{"text", kEndedInConstructor}}}));
}

TEST_F(EndedProcess, IsACrashedRunOfASweep) {
  const CommandResult result = with({"sweep", "--json", "--seeds", "1..2"}, "exits");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("parse error")));
  const auto spread = nlohmann::json::parse(result.out)[0];
  EXPECT_EQ(spread["statuses"], (nlohmann::json{{"crashed", 2}}));
  EXPECT_EQ(spread["failed"][0]["reason"], kEndedInStep);
}

TEST_F(EndedProcess, IsABrokenLawOfItsPlugin) {
  const CommandResult result = run_command(
      {armature(), "plugin", "verify", "test/breaker", "--params", "{breaks: exits}"}, options_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, testing::HasSubstr("ended the process (exit code 0) in its step"));
}

}  // namespace
}  // namespace armature::test
