// SPDX-License-Identifier: Apache-2.0
// A drill passes what stops, fails what does not, and is not begun where metal would move.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/runtime/processes/instance_lock.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;

constexpr std::chrono::seconds kWithin{180};

const Command::Options kWithFaultPlugins{.environment = {{"ARMATURE_PLUGIN_PATH", FAULT_PLUGINS}},
                                         .input = {}};

std::vector<std::string> drill(const std::string& file, std::vector<std::string> options) {
  std::vector<std::string> words{armature(), "drill", source_file(file), "--domain",
                                 std::to_string(unique_dds_domain())};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

/// What became of the runaway arm when it was interrupted in its one process.
json interrupted_runaway(const std::string& setting) {
  const CommandResult result = run_command(
      drill("tests/faults/runaway.yaml", {"--faults", "interrupt", "--json", "--set", setting}),
      kWithFaultPlugins, kWithin);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json told = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(told.is_object()) << result.out;
  EXPECT_EQ(told.value("passed", -1), 0) << result.out;
  return told.value("faults", json::array({json::object()}))[0];
}

TEST(Drill, TheBiopsyPassesInItsShortForm) {
  const CommandResult result =
      run_command(drill("configs/sr1_biopsy.yaml", {"--short", "--seed", "1"}), {}, kWithin);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("sr1_biopsy: --seed 1\n"));
  EXPECT_THAT(result.out, ContainsRegex("\n[1-9][0-9]* passed, 0 failed\n"));
}

TEST(Drill, AnArmThatDoesNotStopFailsItWithItsJointAndItsSpeed) {
  const json row = interrupted_runaway("components.arm.params.jumps=false");
  EXPECT_EQ(row["form"], "single");
  EXPECT_EQ(row["passed"], false);
  EXPECT_THAT(row["arm"].get<std::string>(),
              HasSubstr("'arm' was still moving at its end: joint j"));
  EXPECT_THAT(row["shown"].get<std::string>(), HasSubstr("stopping: interrupted"));
}

TEST(Drill, AnArmThatJumpsToItsRestFailsIt) {
  const json row = interrupted_runaway("components.arm.params.jumps=true");
  EXPECT_THAT(row["arm"].get<std::string>(), HasSubstr("'arm' was beyond its limits: joint j1 at"));
}

/// The run that a drill has started, whichever of its threads did; 0: none yet.
pid_t run_of(pid_t drill) {
  std::error_code none;
  const std::filesystem::path tasks = "/proc/" + std::to_string(drill) + "/task";
  for (const auto& task : std::filesystem::directory_iterator{tasks, none}) {
    std::ifstream children{task.path() / "children"};
    for (pid_t child = 0; children >> child;) {
      std::ifstream line{"/proc/" + std::to_string(child) + "/cmdline"};
      std::string program, verb;
      std::getline(line, program, '\0');
      if (std::getline(line, verb, '\0') && verb == "run") return child;
    }
  }
  return 0;
}

class InterruptedDrill : public testing::TestWithParam<int> {};

TEST_P(InterruptedDrill, EndsTheRunThatItHasStartedBeforeItEndsItself) {
  Command drilled{drill("configs/sr1_biopsy.yaml",
                        {"--faults", "interrupt", "--within", "0", "--moments", "9", "--json"})};
  const auto end = std::chrono::steady_clock::now() + kWithin;
  while (run_of(drilled.pid()) == 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  std::this_thread::sleep_for(std::chrono::milliseconds{GetParam()});
  const pid_t run = run_of(drilled.pid());
  drilled.signal(SIGINT);
  const CommandResult result = drilled.finish(std::chrono::seconds{15});
  EXPECT_FALSE(result.timed_out);
  if (run != 0) {
    EXPECT_TRUE(ends_within(run, std::chrono::seconds{0}));
  }
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: interrupted; runs that were started come to rest first\n");
  const json told = json::parse(result.out, nullptr, false);
  EXPECT_EQ(told.value("stopped", ""), "interrupted") << result.out;
  EXPECT_EQ(told.value("failed", -1), 0) << "a trial that was interrupted has not failed";
}

INSTANTIATE_TEST_SUITE_P(BeforeItsStartAndWhileItMoves, InterruptedDrill, testing::Values(0, 1500),
                         [](const auto& ms) { return std::to_string(ms.param) + "ms"; });

/// What became of the faults of a drill that is over, with its exit code.
json told_by(const CommandResult& result, int exit_code) {
  EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
  json told = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(told.is_object()) << result.out;
  return told.is_object() ? told : json::object();
}

TEST(Drill, AnArmThatStandsAfterAFaultThatTheRunGoesOnWithFailsIt) {
  const json told = told_by(run_command(drill("tests/faults/runaway.yaml",
                                              {"--faults", "stranger", "--within", "0.1", "--json",
                                               "--set", "components.arm.params.stands_after_s=1"}),
                                        kWithFaultPlugins, kWithin),
                            1);
  EXPECT_EQ(told.value("failed", -1), 2) << told;
  EXPECT_EQ(told["faults"][0]["arm"], "'arm', which moved at the fault, did not go on within 10 s");
}

TEST(Drill, AFaultWhoseRunTheTaskEndsItselfIsNotTriedAndNotPassed) {
  const json told =
      told_by(run_command(drill("tests/faults/tour.yaml", {"--faults", "emergency_stop", "--json"}),
                          {}, kWithin),
              1);
  EXPECT_EQ(told.value("passed", -1), 0) << told;
  EXPECT_EQ(told.value("failed", -1), 0) << told;
  EXPECT_EQ(told.value("not_tried", -1), 2) << told;
  EXPECT_EQ(told["faults"][0]["not_tried"], "the task gave up");
  EXPECT_EQ(told["faults"][0]["passed"], false);
}

TEST(Drill, ARunWhoseTaskGivesUpAtAStopIsRearmedAllTheSame) {
  const CommandResult result =
      run_command(drill("configs/sr1_biopsy.yaml", {"--faults", "rearm"}), {}, kWithin);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("\n2 passed, 0 failed\n"));
}

TEST(Drill, IsRefusedWhereMetalMoves) {
  const CommandResult result =
      run_command(drill("tests/faults/runaway.yaml", {"--set", "components.arm.plugin=test/metal"}),
                  kWithFaultPlugins, kWithin);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "armature: 'arm' (test/metal) moves metal, and a drill kills a moving machine; only "
            "deployments whose drivers are all 'simulated: true' in plugin.yaml are drilled\n");
}

TEST(Drill, IsRefusedWhereADeploymentRuns) {
  const std::vector<std::string> drilled = drill("configs/sr1_biopsy.yaml", {});
  Command run{{armature(), "run", source_file("configs/sr1_biopsy.yaml"),
               source_file("configs/overlays/operated.yaml"), "--domain", drilled[4]}};
  ASSERT_TRUE(run.wait_for_err("asks the operator", kWithin)) << run.err();
  const CommandResult result = run_command(drilled, {}, kWithin);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: deployment 'sr1_biopsy' (pid " + std::to_string(run.pid()) +
                            ") runs in domain " + drilled[4] +
                            ", and a drill would stop its arms; name another domain with "
                            "--domain, or none\n");
  EXPECT_THAT(run.err(), testing::Not(HasSubstr("stopping")));
}

TEST(Drill, IsRefusedWhereAnotherDrillIsHeld) {
  const std::vector<std::string> drilled = drill("configs/sr1_biopsy.yaml", {"--short"});
  const auto other = InstanceLock::take("drill domain " + drilled[4]);
  ASSERT_TRUE(other);
  const CommandResult result = run_command(drilled, {}, kWithin);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: another drill (pid " + std::to_string(getpid()) +
                            ") has domain " + drilled[4] +
                            "; name another domain with --domain, or none\n");
}

TEST(Drill, IsRefusedWhereThereIsNoArm) {
  const CommandResult result = run_command(
      drill("tests/faults/runaway.yaml", {"--set", "components.arm.plugin=test/breaker"}),
      kWithFaultPlugins, kWithin);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("deployment 'runaway' has no component with 'driver:'"));
}

TEST(Drill, AFaultThatIsNoneIsNamed) {
  const CommandResult result =
      run_command(drill("configs/sr1_biopsy.yaml", {"--faults", "interupt"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "armature: no fault 'interupt'; did you mean 'interrupt'?\n");
}

TEST(Drill, FaultsOfWhichTheDeploymentCanMeetNoneAreNamedAndDoNotPass) {
  const CommandResult result = run_command(
      drill("tests/faults/runaway.yaml", {"--faults", "perception_killed,monitor_throws"}),
      kWithFaultPlugins, kWithin);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "armature: deployment 'runaway' cannot meet these faults: perception_killed, "
            "monitor_throws\n");
}

}  // namespace
}  // namespace armature::test
