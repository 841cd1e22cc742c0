// SPDX-License-Identifier: Apache-2.0
// A component that throws, hangs or crashes: on the way to the arm it ends the run, elsewhere the
// run goes on without it, and whoever it was is named. The deployment is a source that an arm
// obeys, and a monitor whose notes nobody reads.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/values/sanitizer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr double kTimeLimit_s = 3;

class ComponentFaults : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream{file_}
        << "armature: 1\n"
           "name: broken\n"
           "executors: {control: {}, monitor: {}}\n"
           "components:\n"
           "  source: {plugin: test/breaker}\n"
           "  arm: {plugin: test/driver, executor: control}\n"
           "  monitor: {plugin: test/breaker, topics: monitor, executor: monitor}\n";
  }

  std::vector<std::string> command(const std::vector<std::string>& settings) const {
    std::vector<std::string> words{
        armature(),     "run",
        file_.string(), "--json",
        "--domain",     std::to_string(domain_),
        "--set",        "run.time_limit_s=" + std::to_string(kTimeLimit_s)};
    for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
    return words;
  }
  CommandResult run(const std::vector<std::string>& settings) const {
    return run_command(command(settings), options_);
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "broken.yaml";
  int domain_ = unique_dds_domain();
  Command::Options options_{.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}}, .input = {}};
};

TEST_F(ComponentFaults, WhenNothingBreaksTheRunIsOk) {
  const CommandResult result = run({"run.time_limit_s=0.3"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out)["status"], "ok");
}

TEST_F(ComponentFaults, AMonitorThatThrowsIsIsolatedAndTheRunSaysSoAtItsEnd) {
  const CommandResult result = run({"components.monitor.params.breaks=throws"});
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_EQ(told["reason"],
            "monitor: step failed: a marker has no colour (the run went on without it)");
  EXPECT_GT(told["last_note_s"], 0.5 * kTimeLimit_s) << "the arm was told on";
  EXPECT_THAT(result.err, HasSubstr("FAULT: step failed: a marker has no colour"));
}

TEST_F(ComponentFaults, AMonitorThatThrowsInAnotherProcessIsToldByTheMainOne) {
  const CommandResult result =
      run({"components.monitor.params.breaks=throws", "components.monitor.process=aside"});
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_THAT(
      told["reason"].get<std::string>(),
      HasSubstr("monitor: step failed: a marker has no colour (the run went on without it)"));
  EXPECT_GT(told["last_note_s"], 0.5 * kTimeLimit_s);
}

TEST_F(ComponentFaults, WhatAMonitorPrintsOnStandardOutputIsNoPartOfTheResult) {
  const CommandResult result = run({"components.monitor.params.breaks=prints"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(json::accept(result.out)) << result.out;
  for (const char* printed : {"[printed\n", "[streamed\n", "[echoed\n"}) {
    EXPECT_THAT(result.err, HasSubstr(printed));
  }
}

TEST_F(ComponentFaults, ASourceThatThrowsEndsTheRun) {
  const CommandResult result = run({"components.source.params.breaks=throws"});
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["reason"], "source: step failed: a marker has no colour");
  EXPECT_LT(told["last_note_s"], 0.5 * kTimeLimit_s);
}

TEST_F(ComponentFaults, TheFileMaySayWhatAFaultDoes) {
  const json went_on = json::parse(
      run({"components.source.params.breaks=throws", "components.source.on_fault=isolate"}).out);
  EXPECT_EQ(went_on["reason"],
            "source: step failed: a marker has no colour (the run went on without it)");
  const json ended = json::parse(
      run({"components.monitor.params.breaks=throws", "components.monitor.on_fault=stop"}).out);
  EXPECT_EQ(ended["reason"], "monitor: step failed: a marker has no colour");
}

TEST_F(ComponentFaults, AFileThatIsolatesWhatMovesAnArmIsRefused) {
  const std::string reason =
      "component 'arm' moves an arm, and 'on_fault: isolate' would let the run go on when it "
      "fails; leave 'on_fault' out, and its fault stops the run\n";
  for (const char* verb : {"check", "run"}) {
    const CommandResult result = run_command(
        {armature(), verb, file_.string(), "--set", "components.arm.on_fault=isolate"}, options_);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr(reason));
  }
  const CommandResult told = run_command(
      {armature(), "check", file_.string(), "--set", "components.source.on_fault=isolate"},
      options_);
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.err, HasSubstr("warning: component 'source' leads to what moves an arm, and is "
                                  "isolated: "));
}

TEST_F(ComponentFaults, AMonitorThatHangsIsNamedAndShownAndTheRunGoesOn) {
  const std::vector<std::string> settings{"components.monitor.params.breaks=hangs",
                                          "components.monitor.params.hangs_s=6",
                                          "run.time_limit_s=9"};
  Command broken{command(settings), options_};
  ASSERT_TRUE(
      broken.wait_for_err("the step of 'monitor' has not returned for ", std::chrono::seconds{30}))
      << broken.err();
  const CommandResult states =
      run_command({armature(), "topic", "echo", "/broken/component_states", "-n", "4", "--json",
                   "--domain", std::to_string(domain_)});
  EXPECT_EQ(states.exit_code, 0) << states.err;
  EXPECT_THAT(states.out, HasSubstr(R"("state":3,"reason":"its step has not returned for )"));
  const CommandResult result = broken.finish(std::chrono::seconds{30});
  EXPECT_THAT(result.err, HasSubstr("the step of 'monitor' has returned"));
  EXPECT_EQ(json::parse(result.out)["status"], "ok") << result.out;
  EXPECT_EQ(result.exit_code, 0);
}

TEST_F(ComponentFaults, ASourceThatHangsEndsTheRun) {
  const CommandResult result =
      run({"components.source.params.breaks=hangs",
           "components.source.params.hangs_s=" + std::to_string(kSanitized ? 5 : 2)});
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_THAT(told["reason"].get<std::string>(),
              HasSubstr("the step of 'source' has not returned for "));
}

TEST_F(ComponentFaults, ACrashNamesTheComponentWhoseStepRan) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const CommandResult result = run({"components.monitor.params.breaks=crashes"});
  EXPECT_EQ(result.exit_code, 128 + SIGSEGV);
  EXPECT_THAT(result.err,
              HasSubstr("armature: component 'monitor' crashed in its step: SIGSEGV\n"));
}

TEST_F(ComponentFaults, ACrashInAConstructorIsNamedByTheRunAndByTheCheck) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const std::string breaks = "components.monitor.params.breaks=crashes_when_made";
  const auto check_it = [&] {
    return run_command({armature(), "check", file_.string(), "--set", breaks}, options_);
  };
  for (const CommandResult& result : {run({breaks}), check_it()}) {
    EXPECT_EQ(result.exit_code, 128 + SIGSEGV);
    EXPECT_THAT(result.err,
                HasSubstr("armature: component 'monitor' crashed in its constructor: SIGSEGV\n"));
  }
}

TEST_F(ComponentFaults, ACrashInADestructorIsNamed) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const CommandResult result =
      run({"components.monitor.params.breaks=crashes_at_its_end", "run.time_limit_s=0.3"});
  EXPECT_EQ(result.exit_code, 128 + SIGSEGV);
  EXPECT_THAT(result.err,
              HasSubstr("armature: component 'monitor' crashed in its destructor: SIGSEGV\n"));
}

TEST_F(ComponentFaults, AProcessOfMonitorsThatCrashesIsSaidAtOnceAndTheRunGoesOn) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer tells of a crash by itself";
  const CommandResult result =
      run({"components.monitor.params.breaks=crashes", "components.monitor.process=aside"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("armature: component 'monitor' crashed in its step: SIGSEGV"));
  EXPECT_THAT(
      result.err,
      ContainsRegex("runtime   process 'aside' \\(pid [0-9]+\\) was killed by signal 11 "
                    "\\(Segmentation fault\\), isolated: the run goes on without it\n(.|\n)*"
                    "runtime   stopping: the time limit of 3 s is over\n"));
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_THAT(told["reason"].get<std::string>(),
              ContainsRegex("^process 'aside' \\(pid [0-9]+\\) was killed by signal 11 "
                            "\\(Segmentation fault\\) \\(the run went on without it\\)$"));
  EXPECT_GT(told["last_note_s"], 0.5 * kTimeLimit_s) << "the arm was told on";
}

TEST_F(ComponentFaults, AnIsolatedProcessThatTheArmReadsFromFallsSilentOnceAndTheRunGoesOn) {
  const CommandResult result =
      run({"components.source.params.breaks=crashes", "components.source.process=aside",
           "components.source.on_fault=isolate", "components.monitor.process=second"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(", isolated: the run goes on without it\n"));
  const std::string fell_silent = "fell silent: its process died or hangs\n";
  const std::size_t first = result.err.find(fell_silent);
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(fell_silent, first + 1), std::string::npos)
      << "told once, however many hear it: " << result.err;
  EXPECT_THAT(result.err, HasSubstr("runtime   stopping: the time limit of 3 s is over\n"));
  const json told = json::parse(result.out);
  EXPECT_EQ(told["status"], "fault");
  EXPECT_THAT(told["reason"].get<std::string>(), HasSubstr("(the run went on without it)"));
  EXPECT_GT(told["last_note_s"], 0);
  EXPECT_LT(told["last_note_s"], 0.5 * kTimeLimit_s) << "its output ended with it";
}

TEST_F(ComponentFaults, AProcessThatHoldsMoreThanMonitorsEndsTheRunWhenAMonitorCrashesIt) {
  const CommandResult result =
      run({"components.monitor.params.breaks=crashes", "components.monitor.process=aside",
           "components.source.process=aside"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("runtime   stopping: process 'aside' (pid "));
  EXPECT_THAT(result.err, Not(HasSubstr("isolated")));
  EXPECT_LT(json::parse(result.out)["last_note_s"], 0.5 * kTimeLimit_s);
}

TEST_F(ComponentFaults, WithoutAnArmEveryFaultEndsTheRun) {
  const CommandResult result =
      run({"components.monitor.params.breaks=throws", "components.arm=null"});
  EXPECT_THAT(result.err, Not(HasSubstr("armature:"))) << result.err;
  EXPECT_EQ(json::parse(result.out)["reason"], "monitor: step failed: a marker has no colour");
}

TEST_F(ComponentFaults, CheckTellsWhoSharesTheArmsExecutorWithoutNeedAndShowWhoseFaultsEndTheRun) {
  const auto command = [&](const char* verb, const char* setting) {
    return run_command({armature(), verb, file_.string(), "--set", setting}, options_);
  };
  EXPECT_EQ(command("check", "clock=system").err, "");
  EXPECT_EQ(command("check", "components.monitor.executor=control").err,
            "warning: component 'arm' moves an arm and shares the executor 'control' with monitor: "
            "when a step of theirs is long or hangs, the arm waits; name another executor for "
            "them\n");
  EXPECT_THAT(command("show", "clock=system").out,
              HasSubstr("# a fault of these ends the run: source arm\n"
                        "# of these it stays where it is: monitor\n"));
}

TEST_F(ComponentFaults, AMonitorThatThrowsDoesNotEndTheWorkOfTheNeedle) {
  const CommandResult result = run_command(
      {armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--json", "--domain",
       std::to_string(domain_), "--set", "clock=simulated", "--set",
       "components.colours={plugin: test/breaker, params: {breaks: throws}, executor: monitor}"},
      options_, std::chrono::seconds{120});
  EXPECT_EQ(result.exit_code, 1);
  const json told = json::parse(result.out);
  EXPECT_EQ(told["reasons"], (json{"colours: step failed: a marker has no colour (the run went on "
                                   "without it)"}))
      << "all goals are met";
}

}  // namespace
}  // namespace armature::test
