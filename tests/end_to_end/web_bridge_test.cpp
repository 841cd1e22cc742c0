// SPDX-License-Identifier: Apache-2.0
// The component bridge/web in whole runs.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "armature/recording/recording_test.hpp"
#include "command.hpp"
#include "foxglove_client.hpp"
#include "tests/dds_domain.hpp"
#include "tests/http.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kRunPatience{60};

class WebBridge : public testing::Test {
 protected:
  Command start(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{armature(),
                                   "run",
                                   source_file("tests/end_to_end/arm_watched.yaml"),
                                   "--set",
                                   "clock=system",
                                   "--set",
                                   "components.web={plugin: bridge/web, params: {port: 0}}",
                                   "--domain",
                                   std::to_string(domain_)};
    words.insert(words.end(), more.begin(), more.end());
    return Command{words};
  }
  /// The port that a run tells.
  static int port_of(const Command& run) {
    const std::string kLink = "http://127.0.0.1:";
    EXPECT_TRUE(run.wait_for_err(kLink, kRunPatience)) << run.out() << run.err();
    const std::string told = run.err();
    return std::stoi(told.substr(told.find(kLink) + kLink.size()));
  }
  static json joints(int port) {
    WebSocket socket{port, protocol("foxglove.sdk.v1")};
    subscribe(7, channel_of("/watched/arm/measured_js", socket), socket);
    return message_of(7, "sensor_msgs/JointState", socket);
  }

  const int domain_ = unique_dds_domain();
};

TEST_F(WebBridge, ShowsTheRunThatItIsAPartOf) {
  Command run = start();
  const int port = port_of(run);
  EXPECT_EQ(joints(port)["position"].size(), 6U);
  const std::string page = text_of(source_file("apps/monitor/bundle/index.html"));
  EXPECT_TRUE(HttpClient(port, "GET /").read_all().ends_with("\r\n\r\n" + page));
  run.signal(SIGINT);
  EXPECT_EQ(run.finish(kRunPatience).exit_code, 0) << run.err();
}

TEST_F(WebBridge, ShowsAllProcessesFromOneOfItsOwn) {
  Command run = start({"--set", "components.web.process=aside"});
  EXPECT_EQ(joints(port_of(run))["name"][0], "j1");
}

TEST_F(WebBridge, EndsWithTheRunWhileAClientIsConnected) {
  Command run = start();
  WebSocket socket{port_of(run), protocol("foxglove.sdk.v1")};
  subscribe(1, channel_of("/watched/arm/measured_js", socket), socket);
  message_of(1, "sensor_msgs/JointState", socket);
  const auto begin = steady_clock::now();
  run.signal(SIGINT);
  const auto ended = run.finish(kRunPatience);
  const std::chrono::duration<double> took = steady_clock::now() - begin;
  EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  EXPECT_THAT(ended.err, ::testing::Not(HasSubstr("hang")));
  // A round of the server takes 0.1 s, and DDS its time to leave; a test machine is busy.
  EXPECT_LT(took.count(), 3);
}

TEST_F(WebBridge, APortInUseIsRefusedBeforeTheRun) {
  Command first = start();
  const std::string port = std::to_string(port_of(first));
  const CommandResult second = run_command(
      {armature(), "run", source_file("tests/end_to_end/arm_watched.yaml"), "--set", "clock=system",
       "--set", "components.web={plugin: bridge/web, params: {port: " + port + "}}", "--domain",
       std::to_string(unique_dds_domain())});
  EXPECT_EQ(second.exit_code, 3) << second.out;
  EXPECT_THAT(second.err, HasSubstr("cannot listen at 127.0.0.1:" + port +
                                    ": another program is there, or the address is not of this "
                                    "machine; take another port, or 0 for any that is free"));
}

TEST_F(WebBridge, ChecksAFileWhoseDeploymentIsRunning) {
  Command first = start();
  const std::string port = std::to_string(port_of(first));
  const CommandResult check =
      run_command({armature(), "check", source_file("tests/end_to_end/arm_watched.yaml"), "--set",
                   "clock=system", "--set",
                   "components.web={plugin: bridge/web, params: {port: " + port + "}}"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

TEST_F(WebBridge, IsNamedByAReplayAndLeavesTheRestIdentical) {
  const RecordingFile file{"with-web"};
  Command run =
      start({"--set", "record.file=" + file.path().string(), "--set", "run.time_limit_s=2"});
  EXPECT_EQ(joints(port_of(run))["position"].size(), 6U);
  EXPECT_EQ(run.finish(kRunPatience).exit_code, 0) << run.err();
  const CommandResult replay = run_command({armature(), "replay", file.path().string(), "--check"});
  EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("not replayed: 'web', bridge/web says pure: false"));
}

TEST_F(WebBridge, IsRefusedByNameOnTheSimulatedClock) {
  const CommandResult check =
      run_command({armature(), "check", source_file("tests/end_to_end/arm_watched.yaml"), "--set",
                   "components.web={plugin: bridge/web}"});
  EXPECT_EQ(check.exit_code, 3);
  EXPECT_THAT(check.err, HasSubstr("'bridge/web'"));
}

}  // namespace
}  // namespace armature::test
