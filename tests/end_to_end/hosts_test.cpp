// SPDX-License-Identifier: Apache-2.0
// One deployment on two machines: each is given the same file, and all that a run on one machine
// promises holds over the cable between them, or ends in order when that is cut.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "other_machines_test.hpp"

namespace armature::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class Hosts : public OtherMachines {
 protected:
  explicit Hosts(const std::vector<std::string>& faults = {}) : OtherMachines{faults} {}

  /// The pulse, whose beat is at the desk.
  static std::vector<std::string> pulse(const std::string& listens_s) {
    return {kJoined, "components.beat.host=desk", "components.ear.params.listens_s=" + listens_s};
  }
  std::unique_ptr<Command> start_main(std::vector<std::string> settings) const {
    return start(robot_, kPulse, std::move(settings));
  }
  std::unique_ptr<Command> start_desk(std::vector<std::string> settings) const {
    return start(desk_, kPulse, std::move(settings), {"--host", "desk"});
  }
  /// Once the beat of the desk is heard.
  void expect_started(const Command& main, const Command& desk) const {
    const auto heard = run_command(hz_on(robot_, "/pulse/beat", {"-n", "5", "--timeout", "20"}));
    ASSERT_EQ(heard.exit_code, 0) << heard.err << main.err() << desk.err();
  }

  static constexpr const char* kPulse = "tests/end_to_end/pulse.yaml";
};

TEST_F(Hosts, RunOneDeploymentByOneClock) {
  const auto main = start_main(pulse("1")), desk = start_desk(pulse("1"));
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 0) << ended.err << desk_ended.err;
  EXPECT_EQ(desk_ended.exit_code, 0) << desk_ended.err;
  EXPECT_THAT(ended.err, HasSubstr("waiting for host 'desk': run the same file there with --host "
                                   "desk; if it runs already, its messages do not come"));
  EXPECT_THAT(ended.err, ContainsRegex("host 'desk': its clock was [0-9.]+ ms (behind|before) this "
                                       "one \\(round trip [0-9.]+ ms\\), and follows it"));
  // Its monotonic clock is 5000 s ahead.
  auto delays = nlohmann::json::parse(ended.out).at("delays_s").get<std::vector<double>>();
  ASSERT_GT(delays.size(), 50U) << ended.out;
  std::ranges::sort(delays);
  EXPECT_GT(delays.front(), -0.001);
  EXPECT_LT(delays[delays.size() / 2], 0.02);
}

TEST_F(Hosts, HaveARecordingEachThatOneCommandJoinsAndThatComesBackBitForBit) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.mcap", part = folder / "run.aside.mcap",
                    all = folder / "whole.mcap";
  auto settings = pulse("1");
  settings.push_back("record.file=" + file);
  const auto main = start_main(settings), desk = start_desk(settings);
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  ASSERT_EQ(ended.exit_code, 0) << ended.err << desk_ended.err;
  EXPECT_THAT(ended.err, HasSubstr("host 'desk' has recorded run.aside.mcap there; brought here, "
                                   "it is joined by: armature record --merge run.mcap "
                                   "run.aside.mcap -o whole.mcap"));
  const auto merge = run_command({armature(), "record", "--merge", file, part, "-o", all});
  EXPECT_EQ(merge.exit_code, 0) << merge.err;
  EXPECT_THAT(merge.out, HasSubstr(" of 2 processes"));
  const auto replay = run_command({"/usr/bin/env", "ARMATURE_PLUGIN_PATH=" TEST_PLUGINS, armature(),
                                   "replay", all, "--check", "--json"});
  EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
  const auto checked = nlohmann::json::parse(replay.out);
  EXPECT_TRUE(checked["identical"]);
  EXPECT_GT(checked["exchanged"]["compared"], 0);
  EXPECT_EQ(checked["exchanged"]["unwritten"], 0);
  const auto info = nlohmann::json::parse(run_command({armature(), "info", all, "--json"}).out);
  std::vector<std::string> clocks;  // of the desk, at the beginning and at the end
  for (const auto& metadata : info["metadata"]) {
    if (!metadata["values"].contains("clock_ahead_s")) continue;
    EXPECT_EQ(metadata["values"]["process"], "aside");
    clocks.push_back(metadata["values"]["clock_ahead_s"]);
  }
  ASSERT_EQ(clocks.size(), 2U) << info.dump(1);
  for (const std::string& ahead_s : clocks) EXPECT_LT(std::abs(std::stod(ahead_s)), 0.02);
}

TEST_F(Hosts, AreNotAccusedWhenTheRunIsInterruptedBeforeTheyCame) {
  const auto main = start_main(pulse("1"));
  ASSERT_TRUE(main->wait_for_err("waiting for host 'desk'", kTimeout)) << main->err();
  main->signal(SIGINT);
  const auto ended = main->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr("armature: interrupted while it waited for host 'desk'\n"));
  EXPECT_THAT(ended.err, Not(HasSubstr("has not ended")));
}

TEST_F(Hosts, ThatDidNotComeLeaveNoRecordingInTheWayOfTheNextStart) {
  const TemporaryFolder folder;
  const std::string file = folder / "run.mcap";
  auto settings = pulse("1");
  settings.push_back("record.file=" + file);
  const auto main = start_main(settings);
  ASSERT_TRUE(main->wait_for_err("waiting for host 'desk'", kTimeout)) << main->err();
  EXPECT_TRUE(std::filesystem::exists(file));
  main->signal(SIGINT);
  EXPECT_EQ(main->finish(kTimeout).exit_code, 1) << main->err();
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(Hosts, TheOtherOneMayBeThereFirst) {
  const auto desk = start_desk(pulse("0.5"));
  ASSERT_TRUE(desk->wait_for_err("'desk' waits for the main process of 'pulse'", kTimeout));
  std::this_thread::sleep_for(seconds{1});
  const auto main = start_main(pulse("0.5"));
  EXPECT_EQ(main->finish(kTimeout).exit_code, 0) << main->err() << desk->err();
  EXPECT_EQ(desk->finish(kTimeout).exit_code, 0) << desk->err();
}

TEST_F(Hosts, WithAnotherConfigurationAreRefused) {
  const auto main = start_main(pulse("0.5"));
  auto other = pulse("0.5");
  other.push_back("seed=2");
  const auto refused = start_desk(other)->finish(kTimeout);
  EXPECT_EQ(refused.exit_code, 1);
  const std::string why =
      "host 'desk' has another configuration \\(fingerprint [0-9a-f]{8}, here "
      "[0-9a-f]{8}\\): start it with the same file, overlays and --set";
  EXPECT_THAT(refused.err, ContainsRegex("armature: " + why));
  EXPECT_THAT(main->err(), ContainsRegex(why));
  const auto desk = start_desk(pulse("0.5"));
  EXPECT_EQ(main->finish(kTimeout).exit_code, 0) << main->err() << "the right one comes later";
}

TEST_F(Hosts, AreStoppedTogetherFromEither) {
  for (const bool at_the_desk : {false, true}) {
    const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
    expect_started(*main, *desk);
    (at_the_desk ? desk : main)->signal(SIGINT);
    const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
    EXPECT_THAT(ended.err, HasSubstr(at_the_desk ? "stopping: host 'desk': interrupted"
                                                 : "stopping: interrupted"));
    EXPECT_EQ(desk_ended.exit_code, 0) << desk_ended.err;
    EXPECT_THAT(desk_ended.err, Not(HasSubstr("fell silent")));
  }
}

TEST_F(Hosts, DoNotTakeTheMainProcessForDeadWhileItsOwnComponentsEnd) {
  auto settings = pulse("0.5");
  settings.emplace_back("components.mover={plugin: test/mover, process: mover, host: desk}");
  settings.emplace_back("components.slow={plugin: test/beat, topics: slow, params: {stop_s: 3}}");
  const auto main = start_main(settings), desk = start_desk(settings);
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(desk_ended.exit_code, 0) << desk_ended.err;
  EXPECT_THAT(desk_ended.err, Not(HasSubstr("fell silent")));
}

TEST_F(Hosts, ThatACutCableSeparatesEndEachForItself) {
  const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
  expect_started(*main, *desk);
  run_command(robot_.command({"/bin/ip", "link", "set", "dev", "eth0", "down"}));
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err,
              ContainsRegex("stopping: (process 'aside' of )?host 'desk' fell silent for 1 "
                            "s: it is dead, or the network between is"));
  EXPECT_EQ(desk_ended.exit_code, 1);
  EXPECT_THAT(desk_ended.err, HasSubstr("the main process fell silent for 1 s: it is dead, or the "
                                        "network between is; what runs here comes to rest"));
  EXPECT_THAT(desk_ended.err, HasSubstr("stopping: the main process is gone"));
}

TEST_F(Hosts, WhoseMainProcessIsKilledComeToRest) {
  const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
  expect_started(*main, *desk);
  main->signal(SIGKILL);
  const auto desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(desk_ended.exit_code, 1);
  EXPECT_THAT(desk_ended.err, HasSubstr("stopping: the main process is gone"));
}

TEST_F(Hosts, WhoseAgentIsKilledStopTheRun) {
  const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
  expect_started(*main, *desk);
  const pid_t aside = desk->child();
  desk->signal(SIGKILL);
  const auto ended = main->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr("host 'desk' fell silent for 1 s"));
  EXPECT_TRUE(ends_within(aside, kTimeout));
}

TEST_F(Hosts, WhoseClockDriftsFasterThanItCanBeFollowedEndTheRunAsAFault) {
  std::vector<std::string> drifting{"/usr/bin/env", "LD_PRELOAD=" DRIFTING_CLOCK,
                                    "DRIFT_PPM=15000"};
  const auto words = deployment_command(
      {.files = {source_file(kPulse)}, .settings = pulse("1000"), .domain = domain_});
  drifting.insert(drifting.end(), words.begin(), words.end());
  drifting.insert(drifting.end(), {"--host", "desk"});
  const auto main = start_main(pulse("1000"));
  Command desk{desk_.command(drifting),
               {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}}};
  const auto ended = main->finish(kTimeout), desk_ended = desk.finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1) << ended.err;
  EXPECT_EQ(desk_ended.exit_code, 1) << desk_ended.err;
  EXPECT_THAT(ended.err, ContainsRegex("host 'desk': its clock has moved [0-9.]+ ms from that of "
                                       "the main process, faster than its processes can follow"));
}

TEST_F(Hosts, WhoseMainProcessStoodStillAreNotCalledDead) {
  const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
  expect_started(*main, *desk);
  main->signal(SIGSTOP);
  std::this_thread::sleep_for(seconds{2});
  main->signal(SIGCONT);
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, ContainsRegex("was lost: this process stood still for [0-9.]+ s"));
  EXPECT_THAT(ended.err, Not(HasSubstr("it is dead")));
}

TEST_F(Hosts, GoByOneClockAndSoTheirProcessesAreNotStartedByHand) {
  for (const auto& [process, host] : {std::pair{"aside", "desk"}, std::pair{"main", "main"}}) {
    const auto alone = start(desk_, kPulse, pulse("1"), {"--process", process})->finish(kTimeout);
    EXPECT_EQ(alone.exit_code, 3) << alone.err;
    EXPECT_THAT(alone.err, HasSubstr(std::string{"process '"} + process + "' is on host '" + host));
  }
}

TEST_F(Hosts, AreToldOfAnotherMachineThatAnswersUnderTheSameName) {
  const auto main = start_main(pulse("1000")), desk = start_desk(pulse("1000"));
  expect_started(*main, *desk);
  const auto other = start(robot_, kPulse, pulse("1000"), {"--host", "desk"});
  EXPECT_TRUE(main->wait_for_err("another program answers as host 'desk', too", kTimeout))
      << main->err();
}

TEST_F(Hosts, ThatAreUnknownOrTakenAreRefused) {
  const auto unknown = start(desk_, kPulse, pulse("1"), {"--host", "desc"})->finish(kTimeout);
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.err,
              HasSubstr("deployment 'pulse' has no host 'desc'; did you mean 'desk'?"));
  const auto first = start_desk(pulse("1"));
  ASSERT_TRUE(first->wait_for_err("waits for the main process", kTimeout));
  const auto second = start_desk(pulse("1"))->finish(kTimeout);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.err, HasSubstr("host 'desk' of deployment 'pulse' already runs as pid "));
}

/// The greatest speed of a joint in the last line of `armature topic echo --json` [rad/s]; 0 when
/// there is none.
double last_speed_in(const std::string& out) {
  const std::size_t end = out.rfind('\n');
  if (end == std::string::npos) return 0;
  const std::size_t begin = out.rfind('\n', end - 1) + 1;
  const auto sample = nlohmann::json::parse(out.substr(begin, end - begin));
  double greatest = 0;
  for (const double speed : sample.at("velocity")) greatest = std::max(greatest, std::abs(speed));
  return greatest;
}

TEST_F(Hosts, AnArmWhoseCommandsAreCutOffComesToRest) {
  const std::vector<std::string> settings{kJoined, "clock=system", "components.arm.host=desk"};
  const auto main = start(robot_, "configs/sr1_biopsy.yaml", settings);
  const auto desk = start(desk_, "configs/sr1_biopsy.yaml", settings, {"--host", "desk"});
  Command watch{desk_.command({armature(), "topic", "echo", "/sr1_biopsy/arm/measured_js", "--json",
                               "--interface", "eth0", "--domain", std::to_string(domain_)})};
  const auto give_up = std::chrono::steady_clock::now() + kTimeout;
  while (last_speed_in(watch.out()) < 0.05) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << main->err() << desk->err();
    std::this_thread::sleep_for(milliseconds{20});
  }
  run_command(robot_.command({"/bin/ip", "link", "set", "dev", "eth0", "down"}));
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(desk_ended.exit_code, 1);
  EXPECT_THAT(desk_ended.err, Not(HasSubstr("not at rest")));
  watch.signal(SIGINT);
  EXPECT_LT(last_speed_in(watch.finish(kTimeout).out), 1e-9) << desk_ended.err;
}

TEST(HostsOfAFile, AreThoseOfItsProcesses) {
  const auto checked = [](const std::string& word) {
    return run_command({armature(), "check", source_file("tests/end_to_end/pulse.yaml"), "--set",
                        "components.beat.host=desk", "--set", word},
                       {.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}});
  };
  EXPECT_EQ(checked("dds.interfaces=[eth0]").exit_code, 0);
  EXPECT_THAT(checked("seed=1").err,
              HasSubstr("component 'beat' is on another host, and no network "
                        "leads there: name the interfaces to join, dds: "
                        "{interfaces: [eth0]}"));
  EXPECT_THAT(
      checked("components.beat.process=two words").err,
      HasSubstr("'two words' must consist of letters, digits and '_', and begin with no digit"));
  EXPECT_THAT(checked("components.beat.process=main").err,
              HasSubstr("component 'beat' is on host 'desk', and its process 'main' on 'main', as "
                        "always"));
}

class HostsOverABadCable : public Hosts {
 protected:
  HostsOverABadCable()
      : Hosts{{"--seed", "3", "--lost", "0.05", "--doubled", "0.05", "--delay-ms", "1",
               "--jitter-ms", "1"}} {}
};

TEST_F(HostsOverABadCable, RunAndEndAsOverAGoodOne) {
  const auto main = start_main(pulse("3")), desk = start_desk(pulse("3"));
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 0) << ended.err << desk_ended.err;
  EXPECT_EQ(desk_ended.exit_code, 0) << desk_ended.err;
}

TEST_F(HostsOverABadCable, AnArmIsLedByTheOtherHost) {
  const std::vector<std::string> settings{kJoined, "clock=system", "components.arm.host=desk"};
  const auto main = start(robot_, "configs/sr1_biopsy.yaml", settings);
  const auto desk = start(desk_, "configs/sr1_biopsy.yaml", settings, {"--host", "desk"});
  const auto ended = main->finish(seconds{50}), desk_ended = desk->finish(kTimeout);
  EXPECT_EQ(ended.exit_code, 0) << ended.err << ended.out << desk_ended.err;
  EXPECT_EQ(desk_ended.exit_code, 0) << desk_ended.err;
}

class HostsOverAVeryBadCable : public Hosts {
 protected:
  HostsOverAVeryBadCable()
      : Hosts{{"--seed", "7", "--lost", "0.15", "--doubled", "0.2", "--delay-ms", "1",
               "--jitter-ms", "2"}} {}
};

TEST_F(HostsOverAVeryBadCable, GetCommandsLateOrNeverButNeverTwiceOutOfOrderOrTooOld) {
  auto settings = pulse("3");
  settings.emplace_back("components.ear.params.minds_silence=false");
  const auto main = start(robot_, kPulse, settings, {"--json"}), desk = start_desk(settings);
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  ASSERT_EQ(ended.exit_code, 0) << ended.err << desk_ended.err;
  const auto told = nlohmann::json::parse(ended.out);
  EXPECT_GT(told["orders"], 100) << "of 300 that were sent";
  EXPECT_EQ(told["orders_again"], 0);
  EXPECT_GT(told["oldest_order_s"], 0.01) << "the cable is bad";
  EXPECT_LE(told["oldest_order_s"], 0.1);
}

class HostsFarApart : public Hosts {
 protected:
  HostsFarApart() : Hosts{{"--delay-ms", "15"}} {}
};

TEST_F(HostsFarApart, AreRefusedSinceTheirClocksCannotBeKnown) {
  const auto main = start_main(pulse("1")), desk = start_desk(pulse("1"));
  const auto ended = main->finish(kTimeout), desk_ended = desk->finish(kTimeout);
  const std::string why =
      "its clock can be known to half of the round trip of a question only, which "
      "takes 3[0-9].[0-9] ms \\(at most 20 ms\\)";
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, ContainsRegex("host 'desk': " + why + " before the start"));
  EXPECT_EQ(desk_ended.exit_code, 1);
  EXPECT_THAT(desk_ended.err, ContainsRegex("armature: " + why));
}

}  // namespace
}  // namespace armature::test
