// SPDX-License-Identifier: Apache-2.0
// What a user sees of a running deployment from another terminal: time, frames and rates.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <thread>

#include "armature/messages/rcl_interfaces.hpp"
#include "asker.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

std::int64_t nanoseconds(const json& time) {
  return time["sec"].get<std::int64_t>() * 1'000'000'000 + time["nanosec"].get<std::int64_t>();
}

std::vector<json> lines_of(const CommandResult& result) {
  std::vector<json> lines;
  std::istringstream text{result.out};
  for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
  return lines;
}

/// A deployment in the background, and `armature topic` beside it.
class Watched : public testing::Test {
 protected:
  Command start(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{armature(), "run", source_file("tests/end_to_end/" + file),
                                       "--domain", std::to_string(domain_)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Command{arguments};
  }
  /// Until its frames are heard, which takes long on a busy machine.
  void wait_for_frames() const {
    EXPECT_EQ(run_command(topic({"echo", "/tf", "-n", "1", "--timeout", "30"})).exit_code, 0);
  }
  std::vector<std::string> topic(std::vector<std::string> arguments) const {
    std::vector<std::string> all{armature(), "topic"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--domain", std::to_string(domain_)});
    return all;
  }
  /// Beside a program that writes lines of a log again and again, and calls them `type`.
  CommandResult beside(std::string_view type, const std::vector<std::string>& command) const {
    MessageType called = message_type<msg::Log>();
    called.dds_name = type;
    const auto transport = std::move(*FastDdsTransport::make(
        {.network = {.domain = domain_}, .deployment = "stranger", .now = system_now}));
    SamplePool lines{called, 4};
    const auto writer = std::move(*transport->advertise({"rt/chatter", &called, QosProfile::log}));
    const std::jthread thread{[&](const std::stop_token& ended) {
      while (!ended.stop_requested()) {
        SampleRef sample = lines.loan();
        static_cast<msg::Log*>(sample.mutable_message())->level_(255);
        sample.mutable_info().published = system_now();
        writer->offer(sample);
        std::this_thread::sleep_for(std::chrono::milliseconds{100});
      }
    }};
    return run_command(command, {}, std::chrono::seconds{40});
  }
  int domain_ = unique_dds_domain();
};

TEST_F(Watched, OnTheSimulatedClockTellsTheTimeOfItsStamps) {
  Command run = start("arm_watched.yaml");
  Command clock{topic({"echo", "/clock", "-n", "50", "--timeout", "30", "--json"})};
  Command frames{topic({"echo", "/tf", "-n", "50", "--timeout", "30", "--json"})};
  const auto times = lines_of(clock.finish(std::chrono::seconds{40}));
  const auto told = lines_of(frames.finish(std::chrono::seconds{40}));
  ASSERT_EQ(times.size(), 50U) << run.err();
  ASSERT_EQ(told.size(), 50U) << run.err();

  std::int64_t last = -1;
  for (const json& time : times) {
    const std::int64_t now = nanoseconds(time["clock"]);
    EXPECT_EQ(now % 10'000'000, 0);
    EXPECT_GT(now, last);
    last = now;
  }
  // A day of simulated time at the most: stamps of the system clock are 50 years away.
  constexpr std::int64_t kDay = 86'400'000'000'000;
  EXPECT_LT(last, kDay);
  for (const json& message : told) {
    const std::int64_t stamp = nanoseconds(message["transforms"][0]["header"]["stamp"]);
    EXPECT_EQ(stamp % 20'000'000, 0);
    EXPECT_LT(stamp, kDay);
  }
  run.signal(SIGINT);
  EXPECT_EQ(run.finish(std::chrono::seconds{10}).exit_code, 0);
}

TEST_F(Watched, OnTheSystemClockHasNoClockTopic) {
  const Command run = start("arm_watched.yaml", {"--set", "clock=system"});
  wait_for_frames();
  const auto list = run_command(topic({"list", "--json", "--timeout", "3"}));
  std::set<std::string> topics;
  for (const json& entry : json::parse(list.out)) topics.insert(entry["topic"]);
  EXPECT_TRUE(topics.contains("/tf")) << list.out << run.err();
  EXPECT_TRUE(topics.contains("/tf_static"));
  EXPECT_TRUE(topics.contains("/watched/markers"));
  EXPECT_FALSE(topics.contains("/clock"));
}

TEST_F(Watched, TwoArmsShareOneTreeOfFrames) {
  const Command run = start("two_arms_watched.yaml");
  // Latched, and each monitor's own: one who comes late gets both.
  const auto fixed =
      lines_of(run_command(topic({"echo", "/tf_static", "-n", "2", "--timeout", "30", "--json"})));
  const auto moving =
      lines_of(run_command(topic({"echo", "/tf", "-n", "40", "--timeout", "30", "--json"})));
  std::map<std::string, std::string> parents;
  for (const auto* messages : {&fixed, &moving}) {
    for (const json& message : *messages) {
      for (const json& edge : message["transforms"]) {
        const std::string child = edge["child_frame_id"], parent = edge["header"]["frame_id"];
        EXPECT_EQ(parents.try_emplace(child, parent).first->second, parent);
      }
    }
  }
  for (const std::string arm : {"left", "right"}) {
    std::string at = arm + "/tool";
    for (int steps = 0; steps < 20 && parents.contains(at); ++steps) at = parents[at];
    EXPECT_EQ(at, "room") << arm << run.err();
  }
  EXPECT_EQ(parents.size(), 2U * (1 + 6 + 5 + 1))
      << "base, six joints, five of them turned away from their axis, and the tool of each arm";
}

TEST_F(Watched, TopicEchoWhoseReaderGoesAwayEndsInOrder) {
  const Command run = start("arm_watched.yaml", {"--set", "clock=system"});
  std::string line = "set -o pipefail;";
  for (const std::string& word : topic({"echo", "/tf", "--json", "--timeout", "30"})) {
    line += " '" + word + "'";
  }
  const CommandResult result =
      run_command({"/bin/bash", "-c", line + " | head -n 1"}, {}, std::chrono::seconds{40});
  EXPECT_EQ(result.exit_code, 0) << "killed by SIGPIPE: 141" << result.err << run.err();
  EXPECT_EQ(lines_of(result).size(), 1U);
}

TEST_F(Watched, TopicHzPrintsALineEverySecondAndOneInAll) {
  const Command run = start("arm_watched.yaml", {"--set", "clock=system"});
  wait_for_frames();
  const auto result =
      run_command(topic({"hz", "/watched/arm/measured_js", "--timeout", "5", "--json"}), {},
                  std::chrono::seconds{40});
  const auto lines = lines_of(result);
  ASSERT_GE(lines.size(), 3U) << result.out << result.err << run.err();
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    EXPECT_EQ(lines[i]["over"], "second");
    sum += lines[i]["samples"].get<std::uint64_t>();
  }
  EXPECT_EQ(lines.back()["over"], "all");
  EXPECT_GE(lines.back()["samples"], sum);
}

TEST_F(Watched, WhatDidNotComeInTimeIsSaid) {
  // Its answers have a writer, and nobody asks.
  const Command run = start("arm_watched.yaml", {"--set", "components.path.plugin=path/joint_move",
                                                 "--set", "clock=system"});
  wait_for_frames();
  const std::string silent = "/watched/path/response";
  constexpr std::chrono::seconds kTimeout{60};
  Command echo{topic({"echo", silent, "--timeout", "3"})},
      hz{topic({"hz", silent, "--timeout", "3"})};
  Command once{
      topic({"echo", "/tf_static", "-n", "2", "--timeout", "3"})};  // latched, written once
  for (Command* command : {&echo, &hz}) {
    const auto result = command->finish(kTimeout);
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "armature: no sample of '" + silent + "' came within 3 s\n");
  }
  const auto result = once.finish(kTimeout);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "armature: 1 of 2 samples of '/tf_static' came within 3 s\n");
}

TEST_F(Watched, ASampleOfAnUnknownTypeIsJsonToo) {
  const auto result = beside("chat::msg::dds_::Word_",
                             topic({"echo", "/chatter", "-n", "1", "--json", "--timeout", "20"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json unread = lines_of(result).at(0);
  EXPECT_EQ(unread["type"], "chat::msg::dds_::Word_");
  EXPECT_GT(unread["bytes"], 4);
}

TEST_F(Watched, ASampleThatIsNotOfItsTypeDoesNotCount) {
  const auto result = beside("sensor_msgs::msg::dds_::JointState_",
                             topic({"echo", "/chatter", "-n", "1", "--timeout", "6"}));
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.err.find("armature: not a sensor_msgs/JointState: "), std::string::npos)
      << result.err;
  EXPECT_EQ(result.out, "");
}

TEST(TopicHz, RefusesANumberOfSamplesThatHasNoRate) {
  const auto result = run_command({armature(), "topic", "hz", "/tf", "-n", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--count: Value 1 not in range 2 to "), std::string::npos)
      << result.err;
}

TEST_F(Watched, TopicEchoOfATopicThatNobodyWritesNamesItAsRosDoes) {
  const auto result = run_command(topic({"echo", "/lamp/trget", "--timeout", "2"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: nobody writes '/lamp/trget'; domain " + std::to_string(domain_) +
                            " has no topics on loopback; a deployment with `dds:` is heard by "
                            "--interface, --peer or --discovery-server\n");
}

TEST_F(Watched, TopicEchoWaitsForItsTopicAndSaysSo) {
  Command echo{topic({"echo", "/watched/arm/measured_js", "-n", "1", "--json"})};
  EXPECT_TRUE(echo.wait_for_err("nobody writes '/watched/arm/measured_js' yet, waiting for it",
                                std::chrono::seconds{20}));
  Command run = start("arm_watched.yaml");
  const auto result = echo.finish(std::chrono::seconds{40});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(lines_of(result).size(), 1U);
  run.signal(SIGINT);
}

TEST_F(Watched, CtrlCEndsAWatchThatWaits) {
  Command echo{topic({"echo", "/watched/arm/measured_js"})};
  ASSERT_TRUE(echo.wait_for_err("waiting for it", std::chrono::seconds{20}));
  echo.signal(SIGINT);
  EXPECT_TRUE(ends_within(echo.pid(), std::chrono::seconds{2}));
}

TEST_F(Watched, ARunThatKeepsRunningGoesOnAfterItsStoryUntilItIsInterrupted) {
  Command run{{armature(), "run", source_file("tests/faults/tour.yaml"), "--domain",
               std::to_string(domain_), "--set", "components.task.params.rounds=1",
               "--keep-running"}};
  ASSERT_TRUE(run.wait_for_err("the scenario is over; the run goes on until Ctrl-C",
                               std::chrono::seconds{40}));
  EXPECT_EQ(
      run_command(topic({"echo", "/tour/arm/measured_js", "-n", "5", "--timeout", "30"})).exit_code,
      0);
  run.signal(SIGINT);
  const auto result = run.finish(std::chrono::seconds{20});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("status"), std::string::npos);
}

TEST_F(Watched, OnTheSimulatedClockNothingKeepsRunning) {
  const auto result =
      run_command({armature(), "run", source_file("tests/end_to_end/arm_watched.yaml"), "--domain",
                   std::to_string(domain_), "--keep-running"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("add --set clock=system"), std::string::npos) << result.err;
}

TEST_F(Watched, ATimeTooShortToFindOutSaysNothingOfTheDomain) {
  for (const auto& verb : std::vector<std::vector<std::string>>{
           {"echo", "/lamp/target"}, {"hz", "/lamp/target"}, {"list", "--json"}}) {
    auto arguments = verb;
    arguments.insert(arguments.end(), {"--timeout", "0.1"});
    const auto result = run_command(topic(arguments));
    EXPECT_EQ(result.exit_code, 5) << verb.front();
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "armature: no topic of domain " + std::to_string(domain_) +
                              " was found within 0.1 s, which is too short to find out; give it "
                              "1.5 s\n");
  }
}

}  // namespace
}  // namespace armature::test
