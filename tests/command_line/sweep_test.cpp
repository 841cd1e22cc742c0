// SPDX-License-Identifier: Apache-2.0
// `armature sweep`: many seeds of a deployment in lockstep.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "tests/command.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;

class Sweep : public testing::Test {
 protected:
  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> words{armature(), "sweep", source_file("configs/sr1_biopsy.yaml")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  CommandResult sweep(const std::vector<std::string>& more) const {
    return run_command(command(more), {}, std::chrono::seconds{120});
  }
  long finished_runs() const {
    const fs::path file = folder_ / "runs.jsonl";
    if (!fs::exists(file)) return 0;
    const std::string text = text_of(file);
    return std::count(text.begin(), text.end(), '\n');
  }

  const TemporaryFolder above_;
  const fs::path folder_ = above_ / "sweep";
};

TEST_F(Sweep, TellsWhatEverySeedToldByItself) {
  const auto result = sweep({"--seeds", "2,5..7", "--json"});
  const auto told = nlohmann::json::parse(result.out).at(0);
  std::vector<double> errors;
  for (const char* seed : {"2", "5", "6", "7"}) {
    const auto alone =
        run_command({armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--set",
                     std::string{"seed="} + seed, "--domain", "7", "--json"});
    errors.push_back(nlohmann::json::parse(alone.out).at("target_error_mm"));
  }
  EXPECT_EQ(told["figures"]["target_error_mm"]["greatest"], *std::ranges::max_element(errors));
  EXPECT_EQ(told["figures"]["target_error_mm"]["runs"], 4);
}

TEST_F(Sweep, WritesATableAndHistogramsAndGoesOnWhereItStopped) {
  ASSERT_LE(sweep({"--seeds", "1..3", "--out", folder_}).exit_code, 1);
  EXPECT_EQ(finished_runs(), 3);
  EXPECT_THAT(text_of(folder_ / "figures.csv"), HasSubstr("target_error_mm,3,0,"));
  EXPECT_THAT(text_of(folder_ / "target_error_mm.svg"), HasSubstr("</svg>"));
  {
    std::ofstream torn{folder_ / "runs.jsonl", std::ios::app};
    torn << R"({"fingerprint":"abc","se)";  // the machine was switched off
  }
  const auto again = sweep({"--seeds", "1..5", "--out", folder_});
  EXPECT_THAT(again.err, HasSubstr("3 of 5 runs are in "));
  EXPECT_EQ(finished_runs(), 5);
  const auto changed = sweep(
      {"--seeds", "1", "--out", folder_, "--set", "components.head.params.marker_error_mm=0.4"});
  EXPECT_THAT(changed.err, testing::Not(HasSubstr("already"))) << "another file is another run";
}

TEST_F(Sweep, RunsAgainWhatReadsAFileThatHasChanged) {
  fs::create_directories(folder_);
  const fs::path path = folder_ / "knife.csv";
  const auto plan = [&](double depth_m) {
    std::ofstream file{path};
    file << "t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n5,0.01,0," << depth_m << ",0,0,0,1\n";
  };
  const std::vector<std::string> command{armature(),
                                         "sweep",
                                         source_file("configs/master_manipulator.yaml"),
                                         "--seeds",
                                         "1",
                                         "--set",
                                         "components.surgeon.params.path=" + path.string(),
                                         "--out",
                                         folder_ / "out"};
  const auto run = [&] { return run_command(command, {}, std::chrono::seconds{120}); };
  plan(0.01);
  EXPECT_THAT(run().err, testing::Not(HasSubstr("already")));
  EXPECT_THAT(run().err, HasSubstr("1 of 1 runs are in "));
  plan(0.012);
  EXPECT_THAT(run().err, testing::Not(HasSubstr("already"))) << "other data is another run";
}

TEST_F(Sweep, ThatIsInterruptedKeepsWhatHasFinished) {
  Command running{command({"--seeds", "1..100000", "--out", folder_})};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{30};
  while (finished_runs() < 2 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  running.signal(SIGINT);
  EXPECT_EQ(running.finish(std::chrono::seconds{10}).exit_code, 128 + SIGINT);
  EXPECT_GE(finished_runs(), 2);
  // Of the first two seeds one may be slower than the third.
  EXPECT_THAT(sweep({"--seeds", "1..2", "--out", folder_}).err,
              ContainsRegex("[12] of 2 runs are in"));
}

TEST_F(Sweep, AFolderOfAnotherSweepOrOfSomebodyElseIsLeftAlone) {
  fs::create_directories(folder_);
  std::ofstream{folder_ / "runs.jsonl"} << "important notes";
  EXPECT_THAT(sweep({"--seeds", "1", "--out", folder_}).err,
              HasSubstr("runs.jsonl:1: no line of a sweep; give another folder"));
  EXPECT_EQ(text_of(folder_ / "runs.jsonl"), "important notes");
  fs::remove(folder_ / "runs.jsonl");
  Command running{command({"--seeds", "1..100000", "--out", folder_})};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{30};
  while (finished_runs() < 1 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  EXPECT_THAT(sweep({"--seeds", "1", "--out", folder_}).err,
              HasSubstr("another sweep uses this folder"));
}

TEST_F(Sweep, RefusesAssignmentsOfWhatItSetsItself) {
  for (const char* assignment : {"clock=system", "seed=7"}) {
    const auto result = sweep({"--seeds", "1", "--set", assignment});
    EXPECT_EQ(result.exit_code, 2) << assignment;
    EXPECT_THAT(result.err, HasSubstr(std::string{"'"} + assignment + "': a sweep "));
  }
}

TEST_F(Sweep, VariesKeysAndHoldsSweepGoalsAgainstEachCombination) {
  const auto result =
      sweep({"--seeds", "1..4", "--vary",
             "components.registration.plugin=registration/rigid,registration/affine4", "--set",
             "sweep_goals={target_error_mm: {max: 0.0001}}"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("components.registration.plugin=registration/affine4"));
  EXPECT_THAT(result.out, HasSubstr("target_error_mm, max: "));
  EXPECT_THAT(result.out, HasSubstr("MISSED: at most 0.0001"));
}

TEST_F(Sweep, ARunThatIsNotDoneInTimeIsToldAndTriedAgainTheNextTime) {
  const auto result =
      run_command({armature(), "sweep", source_file("configs/dental_implant.yaml"), "--seeds",
                   "1..2", "--json", "--timeout", "0.05", "--out", folder_});
  EXPECT_EQ(result.exit_code, 1);
  const auto told = nlohmann::json::parse(result.out).at(0);
  EXPECT_EQ(told["statuses"]["timed_out"], 2);
  EXPECT_EQ(told["failed"][1]["seed"], 2);
  EXPECT_EQ(told["failed"][1]["reason"], "not done after 0.05 s");
  EXPECT_EQ(finished_runs(), 0);
}

TEST_F(Sweep, ARunMayTakeLongerThanTheClockCanCount) {
  const auto result = sweep({"--seeds", "1", "--timeout", "1e10", "--json"});
  EXPECT_EQ(nlohmann::json::parse(result.out).at(0)["statuses"]["ok"], 1) << result.out;
}

TEST_F(Sweep, WhatIsWrongIsToldBeforeAnythingRuns) {
  EXPECT_THAT(sweep({"--seeds", "3..1"}).err, HasSubstr("goes down"));
  const auto metric = sweep({"--set", "sweep_goals={target_eror_mm: {p95: 1}}"});
  EXPECT_EQ(metric.exit_code, 3);
  EXPECT_THAT(metric.err, HasSubstr("no component measures 'target_eror_mm'; did you mean"));
  EXPECT_THAT(sweep({"--set", "sweep_goals={target_error_mm: {p59: 1}}"}).err,
              HasSubstr("did you mean 'p95'"));
  EXPECT_THAT(sweep({"--set", "sweep_goals={target_error_mm: {share: 0.9}}"}).err,
              HasSubstr("'share' needs 'at_most'"));
  EXPECT_THAT(sweep({"--set", "sweep_goals={target_error_mm: {p95: [2, 1]}}"}).err,
              HasSubstr("at least 2 and at most 1"));
  EXPECT_THAT(sweep({"--set", "sweep_goals={target_error_mm: {share: 1.5, at_most: 1}}"}).err,
              HasSubstr("a share is from 0 to 1"));
  EXPECT_THAT(sweep({"--set", "sweep_goals={target_error_mm: {p95: -1}}"}).err,
              HasSubstr("is never below 0"));
  EXPECT_THAT(sweep({"--pool", "--vary", "goals.line_deviation_mm=1,2"}).err,
              HasSubstr("not the same goals"));
  EXPECT_THAT(sweep({"--vary", "components.motion.ik.plugin=ik/nmeric"}).err,
              HasSubstr("unknown plugin 'ik/nmeric'"));
}

}  // namespace
}  // namespace armature::test
