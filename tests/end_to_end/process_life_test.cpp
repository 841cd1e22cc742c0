// SPDX-License-Identifier: Apache-2.0
// Interrupted, killed, started twice, started without room for shared memory: a clear message, no
// hang, nothing left behind that breaks the next run, and an arm whose last samples are at rest.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "drill/arm_listener.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

// The arm moves and, with two processes, pictures have crossed to the other one and back.
const std::string kRuns = "task      searching 1/9";
constexpr seconds kStartsWithin{60};

/// The lamp, with as much time as it wants.
DeploymentStart endless(int domain, std::vector<std::string> settings = {}) {
  settings.push_back("run.time_limit_s=0");
  settings.push_back("components.report.params.expect_move=true");  // which is far away:
  settings.push_back("components.scene.params.move_at_s=1000000");
  settings.push_back("components.scene.params.move_duration_s=1");
  settings.push_back("components.scene.params.move_mm=[0,10,0]");
  return {.settings = std::move(settings), .domain = domain};
}

/// The lamp's arm, heard from outside of the processes that run it.
class HeardArm {
 public:
  explicit HeardArm(int domain) : listener_{plugins_, deployment_, domain} {}

  /// Waits until the lamp, which has been started, moves it so fast that a stop takes its time.
  bool wait_until_it_moves() {
    const auto end = steady_clock::now() + kStartsWithin;
    const auto in_time = [end] { return steady_clock::now() < end; };
    if (!listener_.find_arms(in_time)) return false;
    while (record().speed_now() < kFast && in_time()) std::this_thread::sleep_for(kPause);
    return in_time();
  }

  /// The run is over. Its last samples may still be on their way.
  void expect_rest() const {
    const auto end = steady_clock::now() + seconds{1};
    while (!drill::rests(end_speed().speed) && steady_clock::now() < end) {
      std::this_thread::sleep_for(kPause);
    }
    EXPECT_TRUE(drill::rests(end_speed().speed)) << "joint " << end_speed().joint << " moves at "
                                                 << end_speed().speed << " rad/s at its end";
  }

 private:
  static constexpr std::chrono::milliseconds kPause{5};
  static constexpr double kFast = 0.5;  // [rad/s], of 1.0 that it is allowed

  drill::ArmRecord record() const { return listener_.records().front(); }
  drill::JointSpeed end_speed() const {
    return record().speed_at_end().value_or(drill::JointSpeed{});
  }

  PluginRegistry plugins_;
  drill::DrilledDeployment deployment_ =
      drill::read_drilled({.files = {source_file("configs/dental_lamp.yaml")}}, plugins_);
  drill::ArmListener listener_;
};

TEST(ProcessLife, AnInterruptedRunEndsAtOnceAndSaysSo) {
  const int domain = unique_dds_domain();
  HeardArm arm{domain};
  Command lamp{deployment_command(endless(domain))};
  ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
  ASSERT_TRUE(arm.wait_until_it_moves());
  lamp.signal(SIGINT);
  const CommandResult result = lamp.finish(seconds{3});
  arm.expect_rest();
  EXPECT_FALSE(result.timed_out) << result.err;
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("armature: interrupted"));
  EXPECT_THAT(result.out, HasSubstr(R"("status":"goals_missed","reason":"interrupted before)"));
}

TEST(ProcessLife, AStandardOutputThatIsClosedIsNotTheNextFileThatIsOpened) {
  const CommandResult result =
      run_command({"/bin/sh", "-c",
                   armature() + " run " + source_file("configs/sr1_biopsy.yaml") +
                       " --json --domain " + std::to_string(unique_dds_domain()) + " >&-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("armature: standard output cannot be written"));
}

struct EndBeforeStart {
  int signal;
  std::string words;
};
class ProcessLifeBeforeStart : public testing::TestWithParam<EndBeforeStart> {};

TEST_P(ProcessLifeBeforeStart, ASignalEndsTheRunAtOnceAndIsToldInItsOwnWords) {
  std::signal(SIGHUP, SIG_DFL);  // a run goes on ignoring what its starter ignores, as under nohup
  const TemporaryFolder folder;
  const auto file = folder / "slow_start.yaml";
  std::ofstream{file} << "armature: 1\nname: slow_start\ncomponents:\n"
                         "  beat: {plugin: test/beat, params: {construction_s: 100}}\n";
  std::ofstream{folder / "report.json"} << R"({"status":"ok"})";
  Command run{{armature(), "run", file, "--json", "--report", folder.path(), "--domain",
               std::to_string(unique_dds_domain())},
              {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  ASSERT_TRUE(run.wait_for_err("being constructed", kStartsWithin)) << run.err();
  run.signal(GetParam().signal);
  const CommandResult result = run.finish(seconds{1});
  std::ifstream report{folder / "report.json"};
  const std::string reported{std::istreambuf_iterator<char>{report}, {}};
  EXPECT_FALSE(result.timed_out) << result.err;
  EXPECT_EQ(result.exit_code, 1);
  const std::string told = GetParam().words + " before the start";
  EXPECT_THAT(result.err, HasSubstr("armature: " + told + "\n"));
  EXPECT_EQ(result.out, R"({"status":"not_started","reason":")" + told + "\"}\n");
  EXPECT_EQ(reported, result.out);
}

INSTANTIATE_TEST_SUITE_P(Signals, ProcessLifeBeforeStart,
                         testing::Values(EndBeforeStart{SIGINT, "interrupted"},
                                         EndBeforeStart{SIGTERM, "terminated"},
                                         EndBeforeStart{SIGHUP, "the terminal was closed"}));

TEST(ProcessLife, AKilledRunTakesItsOtherProcessAlongAndTheNextOneWorksAndEndsClean) {
  const int domain = unique_dds_domain();
  {
    // Of an arm whose own process is killed nothing can be asked.
    Command lamp{deployment_command(endless(domain, kVisionApart))};
    ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
    const pid_t vision = lamp.child();
    ASSERT_GT(vision, 0);
    lamp.signal(SIGKILL);
    EXPECT_EQ(lamp.finish(seconds{10}).exit_code, 128 + SIGKILL);
    EXPECT_TRUE(ends_within(vision, seconds{10}));
  }
  HeardArm arm{domain};
  Command next{deployment_command(endless(domain, kVisionApart))};
  EXPECT_TRUE(next.wait_for_err(kRuns, kStartsWithin)) << next.err();
  const pid_t vision = next.child();
  ASSERT_TRUE(arm.wait_until_it_moves());
  next.signal(SIGINT);
  const CommandResult result = next.finish(seconds{6});
  arm.expect_rest();
  EXPECT_FALSE(result.timed_out) << result.err;
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(ends_within(vision, seconds{0}));
}

/// Without shared memory: where a process is killed that uses it, now and then nothing is heard of
/// the others for a second or more.
DeploymentStart over_udp(DeploymentStart start) {
  start.options.environment["ARMATURE_PLUGIN_PATH"] = FULL_SHARED_MEMORY;
  return start;
}

TEST(ProcessLife, AnArmWhoseMainProcessIsKilledIsAtRestWhenItsOwnProcessEnds) {
  const int domain = unique_dds_domain();
  HeardArm arm{domain};
  const DeploymentStart start = over_udp(endless(domain, {"components.arm.process=aside"}));
  Command lamp{deployment_command(start), start.options};
  ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
  const pid_t aside = lamp.child();
  ASSERT_GT(aside, 0);
  ASSERT_TRUE(arm.wait_until_it_moves());
  lamp.signal(SIGKILL);
  EXPECT_EQ(lamp.finish(seconds{10}).exit_code, 128 + SIGKILL);
  EXPECT_TRUE(ends_within(aside, seconds{10}));
  arm.expect_rest();
}

TEST(ProcessLife, ARunWhoseOtherProcessIsKilledSaysSoAndEnds) {
  const int domain = unique_dds_domain();
  HeardArm arm{domain};
  const DeploymentStart start = over_udp(endless(domain, kVisionApart));
  Command lamp{deployment_command(start), start.options};
  ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
  const pid_t vision = lamp.child();
  ASSERT_GT(vision, 0);
  ASSERT_TRUE(arm.wait_until_it_moves());
  kill(vision, SIGKILL);
  const CommandResult result = lamp.finish(seconds{10});
  arm.expect_rest();
  EXPECT_FALSE(result.timed_out) << result.err;
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("armature: process 'vision' (pid " + std::to_string(vision) +
                                    ") was killed by signal 9 (Killed)"));
}

TEST(ProcessLife, ASecondStartNamesTheFirst) {
  const int domain = unique_dds_domain();
  HeardArm arm{domain};
  Command lamp{deployment_command(endless(domain))};
  ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
  // Whatever the environment of the second one is.
  const CommandResult second = run_command(
      deployment_command(endless(domain)),
      {.environment = {{"XDG_RUNTIME_DIR", "/nowhere"}, {"TMPDIR", "/nowhere"}}, .input = {}},
      seconds{10});
  EXPECT_FALSE(second.timed_out);
  EXPECT_EQ(second.exit_code, 1);
  const std::string reason = "deployment 'dental_lamp' already runs as pid " +
                             std::to_string(lamp.pid()) + " on domain " + std::to_string(domain) +
                             "; stop it, or use another domain with --domain";
  EXPECT_EQ(second.out, R"({"status":"not_started","reason":")" + reason + "\"}\n");
  EXPECT_EQ(second.err, "armature: " + reason + "\n");
  ASSERT_TRUE(arm.wait_until_it_moves()) << "the first goes on";
  lamp.signal(SIGTERM);
  EXPECT_FALSE(lamp.finish(seconds{10}).timed_out);
  arm.expect_rest();
}

TEST(ProcessLife, WithoutRoomInSharedMemoryItSaysSoAndWorksOverUdp) {
  const int domain = unique_dds_domain();
  HeardArm arm{domain};
  const DeploymentStart start = over_udp(endless(domain, kVisionApart));
  Command lamp{deployment_command(start), start.options};
  ASSERT_TRUE(lamp.wait_for_err(kRuns, kStartsWithin)) << lamp.err();
  ASSERT_TRUE(arm.wait_until_it_moves());
  lamp.signal(SIGINT);
  const CommandResult result = lamp.finish(seconds{10});
  arm.expect_rest();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("no shared memory, topics go over UDP: "));
  EXPECT_THAT(result.err, HasSubstr(" has 1 MiB free, 18 MiB are needed"));
}

}  // namespace
}  // namespace armature::test
