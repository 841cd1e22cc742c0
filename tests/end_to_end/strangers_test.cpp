// SPDX-License-Identifier: Apache-2.0
// A program of another vendor writes a topic of the deployment while it runs. Its beats were
// stamped in 1970, so whoever hears one tells of a very old beat.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::seconds;

constexpr double kYears_s = 1e9;

/// The pulse, and a talker on its topic that it has met, and refused where `refused` says so.
struct Overheard {
  DeploymentRun run;
  pid_t talker = 0;
};

Overheard overhear(std::vector<std::string> settings, bool refused) {
  const int domain = unique_dds_domain();
  Command talker{{CYCLONE_TALKER, std::to_string(domain), "rt/pulse/beat"}};
  settings.push_back("components.ear.params.listens_s=1000");
  const DeploymentStart start{
      .files = {source_file("tests/end_to_end/pulse.yaml")},
      .settings = std::move(settings),
      .domain = domain,
      .options = {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  Command pulse{deployment_command(start), start.options};
  EXPECT_TRUE(talker.wait_for_err("matched", seconds{60})) << pulse.err();
  if (refused) {
    EXPECT_TRUE(pulse.wait_for_err("was refused on '/pulse/beat'", seconds{60})) << pulse.err();
  }
  // Its own beat writes this, from when all have met on.
  run_command(
      {armature(), "topic", "echo", "/pulse/order", "-n", "1", "--domain", std::to_string(domain)},
      {}, seconds{60});
  std::this_thread::sleep_for(seconds{1});  // a hundred beats of the talker
  pulse.signal(SIGINT);
  Overheard overheard{.run = {.command = pulse.finish(seconds{20}), .report = {}},
                      .talker = talker.pid()};
  overheard.run.report = overheard.run.command.out;
  return overheard;
}

TEST(Strangers, WhatTheDeploymentItselfWritesIsTakenFromNobodyElse) {
  const auto [run, talker] = overhear({}, true);
  EXPECT_LT(run.figure("oldest_s"), kYears_s) << run.text();
  EXPECT_LT(run.figure("oldest_young_s"), kYears_s);
  const std::string who =
      "participant 'cyclone_talker' \\(pid " + std::to_string(talker) + " on [^)]+\\)";
  EXPECT_THAT(run.command.err,
              testing::ContainsRegex("a writer of " + who + " was refused on '/pulse/beat'"));
  EXPECT_THAT(run.command.err, testing::ContainsRegex("[0-9]+ samples of " + who +
                                                      " on '/pulse/beat' were refused"));
}

TEST(Strangers, AnInputThatTheFileOpensTakesThem) {
  const std::string open = "open=[ear.beat]";
  // The input `young` beside it reads the same topic and is not open.
  const auto apart = overhear({open}, true).run;
  EXPECT_GT(apart.figure("oldest_s"), kYears_s) << apart.text();
  // It is old by its stamp, and young by when it arrived, which is what counts for a stranger's.
  const auto young = overhear({"open=[ear.young]"}, true).run;
  EXPECT_GT(young.figure("oldest_young_s"), kYears_s) << young.text();
  const auto in_one_process = overhear({open, "components.beat.process=main"}, false).run;
  EXPECT_GT(in_one_process.figure("oldest_s"), kYears_s) << in_one_process.text();
}

TEST(Strangers, WhereOneProcessWritesAndReadsNobodyElseIsHeard) {
  const DeploymentStart start{
      .files = {source_file("tests/end_to_end/pulse.yaml")},
      .settings = {"components.beat.process=main", "components.ear.params.listens_s=1000"},
      .domain = unique_dds_domain(),
      .options = {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  Command pulse{deployment_command(start), start.options};
  Command talker{{CYCLONE_TALKER, std::to_string(start.domain), "rt/pulse/beat"}};
  EXPECT_TRUE(pulse.wait_for_err(
      "a writer of participant 'cyclone_talker' (pid " + std::to_string(talker.pid()), seconds{60}))
      << pulse.err();
  pulse.signal(SIGINT);
  DeploymentRun run{.command = pulse.finish(seconds{20}), .report = {}};
  run.report = run.command.out;
  EXPECT_THAT(run.command.err, testing::HasSubstr("writes '/pulse/beat', too, which is this "
                                                  "deployment's own: nobody here hears it\n"));
  EXPECT_LT(run.figure("oldest_s"), kYears_s) << run.text();
}

}  // namespace
}  // namespace armature::test
