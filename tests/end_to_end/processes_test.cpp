// SPDX-License-Identifier: Apache-2.0
// The same file in two processes, over DDS.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"

namespace armature::test {
namespace {

TEST(TwoProcesses, MeetTheSameGoalsOverDds) {
  DeploymentStart start{.settings = kVisionApart};
  start.settings.push_back("run.time_limit_s=150");  // on the system clock of a busy machine
  expect_aligned(run_deployment(start));
}

DeploymentStart pulse(std::vector<std::string> settings) {
  return {.files = {source_file("tests/end_to_end/pulse.yaml")},
          .settings = std::move(settings),
          .options = {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
}

DeploymentRun run_pulse(std::vector<std::string> settings) {
  return run_deployment(pulse(std::move(settings)));
}

TEST(TwoProcesses, WhatOneSendsOnlyOnceAtItsStartReachesTheOther) {
  const auto run =
      run_pulse({"components.beat.params.beats=1", "components.ear.params.listens_s=1"});
  EXPECT_EQ(run.command.exit_code, 0) << run.text();
  EXPECT_TRUE(run.tells("delay_s")) << run.text();
  EXPECT_EQ(run.word("told_of"), "beat ear runtime runtime_log ")
      << "of both processes' components";
}

TEST(TwoProcesses, AStoryThatEndsInTheOtherOneEndsTheRun) {
  const auto run = run_pulse({"components.beat.params.beats=5", "components.beat.params.ends=true",
                              "components.ear.params.listens_s=1000"});
  EXPECT_EQ(run.command.exit_code, 0) << run.text();
  EXPECT_EQ(run.status(), "ok");
  EXPECT_TRUE(run.tells("delay_s")) << run.text();
}

TEST(TwoProcesses, AComponentThatFailsInTheOtherOneEndsTheRunWithItsFault) {
  for (const std::string place : {"construction", "step"}) {
    const auto run = run_pulse(
        {"components.beat.params.throws_in=" + place, "components.ear.params.listens_s=1000"});
    EXPECT_NE(run.command.exit_code, 0) << run.text();
    EXPECT_NE(run.command.err.find("out of breath"), std::string::npos) << run.text();
    EXPECT_FALSE(run.command.timed_out);
  }
}

TEST(TwoProcesses, WhatTheOtherOnesComponentsSayAtTheEndIsSaidOfTheRun) {
  const auto gasping = run_pulse({"components.beat.params.gasps=true",
                                  "components.ear.params.listens_s=1000", "run.time_limit_s=1"});
  EXPECT_EQ(gasping.status(), "degraded") << gasping.text();
  EXPECT_THAT(gasping.report, testing::HasSubstr(R"("unwell":["beat: out of breath"])"));

  const TemporaryFolder folder;
  const std::string files = folder / "report";
  DeploymentStart start =
      pulse({"components.beat.params.fails=true", "components.beat.params.writes_files=true",
             "components.ear.params.listens_s=0.3"});
  start.report_folder = files;
  const auto failed = run_deployment(start);
  EXPECT_EQ(failed.command.exit_code, 1) << failed.text();
  EXPECT_EQ(failed.status(), "failed");
  EXPECT_EQ(failed.word("reason"), "the heart stood still");
  EXPECT_TRUE(std::filesystem::exists(files + "/beats.txt"));
  EXPECT_THAT(content_of(files + "/report.sha256"), testing::HasSubstr("  beats.txt\n"));
}

TEST(TwoProcesses, ATimeLimitIsTheSameForBoth) {
  for (int i = 0; i < 4; ++i) {
    const auto run = run_pulse(
        {"components.ear.params.listens_s=1000", "run.time_limit_s=0.6", "goals={delay_s: 1000}"});
    EXPECT_EQ(run.status(), "goals_missed") << run.text();
    EXPECT_EQ(run.word("ended_by"), "the time limit of 0.6 s is over");
  }
}

TEST(OneProcess, WhatAStepTakesFromTheWholeProcessIsTakenBack) {
  const TemporaryFolder folder;
  DeploymentStart start =
      pulse({"components.beat.process=main", "components.beat.params.takes=folder",
             "components.ear.params.listens_s=0.3"});
  start.report_folder = folder / "report";
  const auto run = run_deployment(start);
  EXPECT_THAT(run.command.err,
              testing::HasSubstr("a plugin has changed the folder that the process "
                                 "works in, to '/'; it is changed back\n"));
  EXPECT_EQ(run.status(), "ok") << run.text();
}

TEST(OneProcess, AFileOfTheReportThatCannotBeWrittenNamesItsComponent) {
  const TemporaryFolder folder;
  DeploymentStart start =
      pulse({"components.beat.process=main", "components.beat.params.throws_in=write_files",
             "components.ear.params.listens_s=0.3"});
  start.report_folder = folder / "report";
  const auto run = run_deployment(start);
  EXPECT_EQ(run.command.exit_code, 1) << run.text();
  EXPECT_THAT(run.command.err, testing::HasSubstr("component 'beat': out of breath\n"));
}

TEST(TwoProcesses, OneThatEndsWithAnotherExitCodeThan0IsAFaultAlsoWhenItHasToldNone) {
  const auto run =
      run_pulse({"components.beat.params.exit_code=3", "components.ear.params.listens_s=1"});
  EXPECT_EQ(run.command.exit_code, 1) << run.text();
  EXPECT_EQ(run.status(), "fault");
  EXPECT_THAT(run.command.err, testing::ContainsRegex("process 'aside' \\(pid [0-9]+\\) ended with "
                                                      "exit code 3"));
}

TEST(TwoProcesses, ThatCameToTheEndOfTheirStoryKnowOfNoTrouble) {
  const std::vector<std::vector<std::string>> ends{
      {"components.ear.params.listens_s=1"},
      {"components.beat.params.beats=5", "components.beat.params.ends=true",
       "components.ear.params.listens_s=1000"}};
  for (std::vector<std::string> settings : ends) {
    const TemporaryFolder folder;
    settings.push_back("record={file: \"" + (folder / "box-%H.mcap").string() +
                       "\", around_faults_s: 1}");
    const auto run = run_pulse(settings);
    EXPECT_EQ(run.status(), "ok") << run.text();
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << run.text();
  }
}

TEST(TwoProcesses, OneThatFailsIsATroubleInBoth) {
  const TemporaryFolder folder;
  run_pulse({"components.beat.params.throws_in=step", "components.ear.params.listens_s=1000",
             "record={file: \"" + (folder / "box-%H.mcap").string() + "\", around_faults_s: 1}"});
  std::size_t boxes = 0, aside = 0;
  for (const auto& entry : std::filesystem::directory_iterator{folder.path()}) {
    ++boxes;
    aside += entry.path().string().ends_with(".aside.mcap") ? 1 : 0;
  }
  EXPECT_GT(aside, 0U);
  EXPECT_GT(boxes, aside);
}

/// The beats that process 'aside' itself has recorded in the black boxes there: how many, and the
/// number of the last. They are joined first.
struct BeatsInBoxes {
  int count = 0;
  std::uint32_t last = 0;
};
BeatsInBoxes beats_in_boxes(const TemporaryFolder& folder) {
  const std::string all = folder / "all.mcap";
  std::vector<std::string> merge{armature(), "record", "--merge"};
  for (const auto& entry : std::filesystem::directory_iterator{folder.path()}) {
    merge.push_back(entry.path());
  }
  merge.insert(merge.end(), {"-o", all});
  const CommandResult merged = run_command(merge);
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  BeatsInBoxes beats;
  McapReader reader{all};
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    if (channel.topic != "/pulse/beat" || channel.metadata.contains("from")) continue;
    ++beats.count;
    beats.last = message->sequence;
  }
  return beats;
}

TEST(TwoProcesses, ATroubleOfOneIsInTheBlackBoxOfTheOtherWhileTheRunGoesOn) {
  const TemporaryFolder folder;
  const auto run = run_pulse(
      {"components.beat.params.beats=100", "components.ear.params.needs_beats=true",
       "components.ear.params.listens_s=3",
       "record={file: \"" + (folder / "box-%H.mcap").string() + "\", around_faults_s: 5}"});
  EXPECT_EQ(run.command.exit_code, 0) << run.text();
  EXPECT_EQ(beats_in_boxes(folder).last, 100U) << "behind which the ear had trouble";
}

TEST(ThreeProcesses, ATroubleOfOneIsInTheBlackBoxesOfAllWhileTheRunGoesOn) {
  const TemporaryFolder folder;
  const auto run = run_pulse(
      {"components.failing={plugin: test/beat, process: third, topics: failing, on_fault: isolate, "
       "params: {throws_in: step}}",
       "components.ear.params.listens_s=2",
       "record={file: \"" + (folder / "box-%H.mcap").string() + "\", around_faults_s: 5}"});
  EXPECT_EQ(run.status(), "fault") << run.text();
  EXPECT_GT(beats_in_boxes(folder).count, 50) << "of 2 s behind the trouble";
}

TEST(TwoProcesses, OneWhoseRecordingCannotBeEndedIsAFault) {
  const TemporaryFolder folder;
  const std::filesystem::path part = folder / "run.aside.mcap", copy = folder / "copy.mcap";
  Command run{deployment_command(pulse({"components.ear.params.listens_s=4",
                                        "record.file=" + (folder / "run.mcap").string()})),
              pulse({}).options};
  const auto is_long = [&] {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(part, none);
    return !none && bytes > 20'000;
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{60};
  while (!is_long() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  std::filesystem::copy_file(part, copy);
  std::filesystem::rename(copy, part);
  const CommandResult result = run.finish(std::chrono::seconds{60});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_NE(result.err.find("process 'aside': its recording has no end"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace armature::test
