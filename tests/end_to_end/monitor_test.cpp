// SPDX-License-Identifier: Apache-2.0
// `armature monitor` as Foxglove and Lichtblick meet it.
#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "foxglove_client.hpp"
#include "tests/dds_domain.hpp"
#include "tests/http.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kPatience{60};

class Monitor : public testing::Test {
 protected:
  Command start(const std::vector<std::string>& more) const {
    std::vector<std::string> words{armature(), "monitor",  "--port",
                                   "0",        "--domain", std::to_string(domain_)};
    words.insert(words.end(), more.begin(), more.end());
    return Command{words};
  }
  /// The port of its first line, "http://127.0.0.1:39201/?token=..".
  static int port_of(const Command& monitor) {
    EXPECT_TRUE(monitor.wait_for_out("\n", kPatience)) << monitor.err();
    const std::string line = monitor.out().substr(0, monitor.out().find('\n'));
    return std::stoi(line.substr(line.rfind(':') + 1));
  }

  const int domain_ = unique_dds_domain();
  Command run_{{armature(), "run", source_file("tests/end_to_end/arm_watched.yaml"), "--set",
                "clock=system", "--domain", std::to_string(domain_)}};
};

TEST_F(Monitor, ShowsTopicsAsTheyAreOnDdsInBothProtocols) {
  Command monitor = start({});
  const int port = port_of(monitor);
  for (const char* name : {"foxglove.websocket.v1", "foxglove.sdk.v1"}) {
    WebSocket socket{port, protocol(name)};
    ASSERT_TRUE(socket.is_open()) << name << monitor.err();
    const auto first = socket.next();
    ASSERT_TRUE(first);
    EXPECT_EQ(json::parse(first->payload)["op"], "serverInfo");
    const json channel = channel_of("/watched/arm/measured_js", socket);
    EXPECT_EQ(channel["encoding"], "cdr");
    EXPECT_EQ(channel["schemaName"], "sensor_msgs/msg/JointState");
    EXPECT_EQ(channel["schemaEncoding"], "ros2msg");
    EXPECT_THAT(channel["schema"].get<std::string>(), HasSubstr("float64[] position\n"));
    subscribe(7, channel, socket);
    const json joints = message_of(7, "sensor_msgs/JointState", socket);
    EXPECT_EQ(joints["name"][0], "j1") << run_.err();
    EXPECT_EQ(joints["position"].size(), 6U);
  }
  monitor.signal(SIGINT);
  EXPECT_EQ(monitor.finish(kPatience).exit_code, 0);
}

TEST_F(Monitor, TellsItsPageAndItsSocketAndServesThePage) {
  const Command monitor = start({});
  const std::string place = "127.0.0.1:" + std::to_string(port_of(monitor));
  EXPECT_TRUE(monitor.wait_for_out("ws://" + place + "\n", kPatience));
  EXPECT_EQ(monitor.out(), "http://" + place + "/\nws://" + place + "\n");
  const std::string answer = HttpClient{port_of(monitor), "GET /"}.read_all();
  const std::string page = text_of(source_file("apps/monitor/bundle/index.html"));
  EXPECT_TRUE(answer.ends_with("\r\n\r\n" + page)) << answer.substr(0, 400);
}

TEST_F(Monitor, GivesWhatIsKeptForLateComersToEachOfThem) {
  const Command monitor = start({});
  const int port = port_of(monitor);
  WebSocket first{port, protocol("foxglove.websocket.v1")};
  const json channel = channel_of("/tf_static", first);
  subscribe(1, channel, first);
  const json told = message_of(1, "tf2_msgs/TFMessage", first);
  EXPECT_FALSE(told["transforms"].empty());
  WebSocket second{port, protocol("foxglove.websocket.v1")};
  channel_of("/tf_static", second);
  subscribe(2, channel, second);
  EXPECT_EQ(message_of(2, "tf2_msgs/TFMessage", second), told);
  // Nobody reads it any more, and then somebody does again.
  first.send_text(R"({"op": "unsubscribe", "subscriptionIds": [1]})");
  second.send_text(R"({"op": "unsubscribe", "subscriptionIds": [2]})");
  subscribe(3, channel, second);
  EXPECT_EQ(message_of(3, "tf2_msgs/TFMessage", second), told);
}

TEST_F(Monitor, PublishesNothingAndSurvivesNonsense) {
  const Command monitor = start({});
  WebSocket socket{port_of(monitor), protocol("foxglove.sdk.v1")};
  channel_of("/tf", socket);
  const auto answer_to = [&](const std::string& said) {
    socket.send_text(said);
    while (const auto frame = socket.next()) {
      const json told = frame->op == 1 ? json::parse(frame->payload) : json::object();
      if (told.value("op", "") == "status") return told["message"].get<std::string>();
    }
    return std::string{};
  };
  EXPECT_EQ(answer_to(R"({"op": "advertise", "channels": []})"),
            "'advertise' is not done here: a monitor only shows");
  EXPECT_EQ(answer_to("light on"), "what was said is no JSON object");
  EXPECT_NE(answer_to(R"({"op": "subscribe", "subscriptions": [{"id": "x"}]})"), "");
  EXPECT_EQ(answer_to(R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]})"),
            "there is no channel 999");
}

TEST_F(Monitor, TakesBackTheTopicsOfADeploymentThatEnds) {
  const Command monitor = start({});
  WebSocket socket{port_of(monitor), protocol("foxglove.websocket.v1")};
  const json channel = channel_of("/watched/arm/measured_js", socket);
  subscribe(1, channel, socket);
  message_of(1, "sensor_msgs/JointState", socket);
  run_.signal(SIGINT);
  bool taken_back = false;
  while (!taken_back) {
    const auto frame = socket.next();
    ASSERT_TRUE(frame) << monitor.err();
    if (frame->op != 1) continue;
    const json told = json::parse(frame->payload);
    if (told["op"] != "unadvertise") continue;
    for (const json& id : told["channelIds"]) taken_back = taken_back || id == channel["id"];
  }
}

TEST_F(Monitor, AsksForATokenBeyondLoopbackAndKnowsWherePagesComeFrom) {
  const Command open = start({"--bind", "0.0.0.0", "--origin", "http://lab.example"});
  const int port = port_of(open);
  const std::string line = open.out();
  const std::string path =
      line.substr(line.find("/?token="), line.find('\n') - line.find("/?token="));
  EXPECT_EQ(path.size(), std::string{"/?token="}.size() + 32) << line;
  const std::string name = protocol("foxglove.sdk.v1");
  EXPECT_FALSE(WebSocket(port, name).is_open());
  EXPECT_TRUE(WebSocket(port, name, path).is_open());
  EXPECT_TRUE(WebSocket(port, name + "Origin: http://lab.example\r\n", path).is_open());
  EXPECT_TRUE(WebSocket(port, name + "Origin: https://app.foxglove.dev\r\n", path).is_open());
  EXPECT_FALSE(WebSocket(port, name + "Origin: http://evil.example\r\n", path).is_open());
  EXPECT_TRUE(
      open.wait_for_err("a page from 'http://evil.example' was refused; to let it in: "
                        "--origin",
                        kPatience));
}

TEST_F(Monitor, TellsOnceOfEachAddressThatItsClientSpeaksAnotherProtocol) {
  const Command monitor = start({});
  const int port = port_of(monitor);
  for (const char* asked : {"rosbridge.v2", "other.v1", "rosbridge.v2"}) {
    const WebSocket socket{port, protocol(asked)};
    EXPECT_TRUE(socket.answer().starts_with("HTTP/1.0 400 ")) << socket.answer();
  }
  EXPECT_TRUE(WebSocket(port, protocol("foxglove.sdk.v1")).is_open());
  EXPECT_EQ(monitor.err(),
            "armature: a WebSocket client at 127.0.0.1 was refused: it asks for the subprotocol "
            "'rosbridge.v2', and only foxglove.sdk.v1 or foxglove.websocket.v1 is spoken here\n");
}

}  // namespace
}  // namespace armature::test
