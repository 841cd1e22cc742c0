// SPDX-License-Identifier: Apache-2.0
// `armature replay run.mcap --monitor` as Foxglove meets it.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>

#include "armature/recording/recording_test.hpp"
#include "command.hpp"
#include "foxglove_client.hpp"
#include "tests/http.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::chrono::seconds kPatience{60};
constexpr std::int64_t kStart_ns = 1'700'000'000'250'000'000, kPeriod_ns = 10'000'000;
constexpr int kCount = 300;

/// "/count": its messages are "0" to "299", one each 10 ms.
void write_counting(const std::filesystem::path& file) {
  McapWriter writer{file, {.chunk_bytes = 2000}};
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  const auto channel =
      writer.add(McapChannel{.schema_id = schema, .topic = "/count", .message_encoding = "cdr"});
  for (int i = 0; i < kCount; ++i) {
    const std::string text = std::to_string(i);
    std::string cdr{"\0\1\0\0", 4};
    const auto size = static_cast<std::uint32_t>(text.size() + 1);
    cdr.append(reinterpret_cast<const char*>(&size), sizeof size);
    cdr.append(text.c_str(), size);
    const Time time{kStart_ns + i * kPeriod_ns};
    writer.write(channel, 0, time, time, std::as_bytes(std::span{cdr}));
  }
  writer.close();
}

struct Told {
  enum { playing = 0, paused = 1, ended = 3 };
  int status = -1;
  std::int64_t at_ns = 0;
  float speed = 0;
  bool jumped = false;
  std::string id;
};

class ReplayMonitor : public testing::Test {
 protected:
  ReplayMonitor() { write_counting(file_.path()); }

  Command start(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{armature(), "replay", file_.path(), "--monitor", "--port", "0"};
    words.insert(words.end(), more.begin(), more.end());
    return Command{words};
  }
  static int port_of(const Command& replay) {
    EXPECT_TRUE(replay.wait_for_out("\n", kPatience)) << replay.err();
    const std::string line = replay.out().substr(0, replay.out().find('\n'));
    return std::stoi(line.substr(line.rfind(':') + 1));
  }
  static void control(WebSocket& socket, bool plays, float speed, std::int64_t seek_ns,
                      const std::string& id) {
    std::string bytes{'\3', plays ? '\0' : '\1'};
    const auto put = [&](auto number) {
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    put(speed);
    bytes += seek_ns > 0 ? '\1' : '\0';
    put(seek_ns);
    put(static_cast<std::uint32_t>(id.size()));
    socket.send_binary(bytes + id);
  }
  static std::optional<Told> read_state(const WebSocket::Frame& frame) {
    if (frame.op != 2 || frame.payload.size() < 19 || frame.payload[0] != 5) return std::nullopt;
    Told told;
    told.status = frame.payload[1];
    std::memcpy(&told.at_ns, frame.payload.data() + 2, sizeof told.at_ns);
    std::memcpy(&told.speed, frame.payload.data() + 10, sizeof told.speed);
    told.jumped = frame.payload[14] != 0;
    told.id = frame.payload.substr(19);
    return told;
  }
  static Told next_state(WebSocket& socket) {
    while (const auto frame = socket.next()) {
      if (const auto told = read_state(*frame)) return *told;
    }
    ADD_FAILURE() << "no state of the playback";
    return {};
  }
  static int next_count(WebSocket& socket) {
    const json message = message_of(1, "std_msgs/String", socket);
    return std::stoi(message["data"].get<std::string>());
  }

  RecordingFile file_{"shown"};
};

TEST_F(ReplayMonitor, TellsFoxgloveThatItCanBePlayedAndHowLongItIs) {
  const Command replay = start();
  WebSocket socket{port_of(replay), protocol("foxglove.sdk.v1")};
  const auto first = socket.next();
  ASSERT_TRUE(first) << replay.err();
  const json info = json::parse(first->payload);
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_THAT(info["capabilities"], Contains("playbackControl"));
  EXPECT_THAT(info["capabilities"], Contains("time"));
  EXPECT_EQ(info["dataStartTime"], json::parse(R"({"sec": 1700000000, "nsec": 250000000})"));
  EXPECT_EQ(info["dataEndTime"], json::parse(R"({"sec": 1700000003, "nsec": 240000000})"));
  const Told told = next_state(socket);
  EXPECT_EQ(told.status, Told::paused) << "until somebody watches";
  EXPECT_EQ(told.at_ns, kStart_ns);
}

TEST_F(ReplayMonitor, TellsThatItPlaysOnceSomebodyLooks) {
  const Command replay = start();
  WebSocket socket{port_of(replay), protocol("foxglove.sdk.v1")};
  const json channel = channel_of("/count", socket);
  EXPECT_EQ(next_state(socket).status, Told::paused);
  subscribe(1, channel, socket);
  const Told told = next_state(socket);
  EXPECT_EQ(told.status, Told::playing) << "nobody has asked";
  EXPECT_FALSE(told.jumped);
}

TEST_F(ReplayMonitor, PlaysPausesAndSeeksAsItIsAsked) {
  Command replay = start();
  WebSocket socket{port_of(replay), protocol("foxglove.sdk.v1")};
  const json channel = channel_of("/count", socket);
  EXPECT_EQ(channel["schemaName"], "std_msgs/msg/String");
  next_state(socket);
  control(socket, false, 1, kStart_ns + 100 * kPeriod_ns, "to the middle");
  const Told middle = next_state(socket);
  EXPECT_EQ(middle.status, Told::paused);
  EXPECT_EQ(middle.at_ns, kStart_ns + 100 * kPeriod_ns);
  EXPECT_TRUE(middle.jumped);
  EXPECT_EQ(middle.id, "to the middle");
  subscribe(1, channel, socket);
  EXPECT_EQ(next_count(socket), 100) << "what was so then";
  control(socket, true, 4, 0, "on");
  const Told on = next_state(socket);
  EXPECT_EQ(on.status, Told::playing);
  EXPECT_EQ(on.speed, 4);
  EXPECT_FALSE(on.jumped);
  EXPECT_EQ(on.id, "on");
  for (int i = 101; i < kCount; ++i) ASSERT_EQ(next_count(socket), i);
  const Told end = next_state(socket);
  EXPECT_EQ(end.status, Told::ended);
  EXPECT_EQ(end.at_ns, kStart_ns + (kCount - 1) * kPeriod_ns);
  EXPECT_EQ(end.id, "") << "nobody has asked";
  control(socket, true, 1, kStart_ns, "again");
  EXPECT_EQ(next_state(socket).status, Told::playing);
  EXPECT_EQ(next_count(socket), 0);
  replay.signal(SIGINT);
  EXPECT_EQ(replay.finish(kPatience).exit_code, 0);
}

TEST_F(ReplayMonitor, TellsTheTimeOfTheRecordingWhileItPlays) {
  const Command replay = start({"--rate", "2"});
  WebSocket socket{port_of(replay), protocol("foxglove.sdk.v1")};
  subscribe(1, channel_of("/count", socket), socket);
  std::int64_t last_ns = 0;
  int times = 0;
  while (last_ns < kStart_ns + (kCount - 1) * kPeriod_ns) {
    const auto frame = socket.next();
    ASSERT_TRUE(frame) << replay.err();
    if (frame->op != 2 || frame->payload[0] != 2) continue;
    std::int64_t ns = 0;
    std::memcpy(&ns, frame->payload.data() + 1, sizeof ns);
    ASSERT_GE(ns, last_ns);
    last_ns = ns;
    ++times;
  }
  EXPECT_GT(times, 15) << "in 1.5 s, on a busy machine, too";
  EXPECT_LT(times, 200) << "each 10 ms at most";
}

TEST_F(ReplayMonitor, AnotherClientIsToldWhatOneHasChanged) {
  const Command replay = start();
  const int port = port_of(replay);
  WebSocket one{port, protocol("foxglove.sdk.v1")}, other{port, protocol("foxglove.sdk.v1")};
  next_state(one);
  next_state(other);
  control(one, false, 3, kStart_ns + kPeriod_ns, "mine");
  const Told told = next_state(other);
  EXPECT_EQ(told.speed, 3);
  EXPECT_TRUE(told.jumped);
  EXPECT_EQ(told.id, "") << "it has not asked";
}

TEST_F(ReplayMonitor, AnOlderClientGetsMessagesAndNothingThatItsProtocolDoesNotHave) {
  const Command replay = start({"--rate", "5"});
  WebSocket socket{port_of(replay), protocol("foxglove.websocket.v1")};
  const auto first = socket.next();
  ASSERT_TRUE(first);
  EXPECT_THAT(json::parse(first->payload)["capabilities"], Not(Contains("playbackControl")));
  subscribe(1, channel_of("/count", socket), socket);
  for (int counted = 0; counted < kCount;) {
    const auto frame = socket.next();
    ASSERT_TRUE(frame);
    if (frame->op != 2) continue;
    ASSERT_LE(frame->payload[0], 2) << "only messages and times";
    if (frame->payload[0] == 1) ++counted;
  }
}

TEST_F(ReplayMonitor, NonsenseIsAnsweredAndSurvived) {
  const Command replay = start();
  WebSocket socket{port_of(replay), protocol("foxglove.sdk.v1")};
  next_state(socket);
  socket.send_binary("\3");
  std::string answer;
  while (answer.empty()) {
    const auto frame = socket.next();
    ASSERT_TRUE(frame) << "no answer";
    const json told = frame->op == 1 ? json::parse(frame->payload) : json::object();
    if (told.value("op", "") == "status") answer = told["message"];
  }
  EXPECT_THAT(answer, HasSubstr("a binary message of 1 bytes is none for playback"));
  control(socket, false, 0, kStart_ns, "still there");
  EXPECT_EQ(next_state(socket).id, "still there");
}

TEST_F(ReplayMonitor, ServesThePageAndEndsWhenItsTimeIsOver) {
  Command replay = start({"--timeout", "2"});
  EXPECT_TRUE(HttpClient(port_of(replay), "GET /").read_all().starts_with("HTTP/1.1 200 "));
  EXPECT_EQ(replay.finish(kPatience).exit_code, 0);
}

TEST_F(ReplayMonitor, OptionsOfAPageNeedIt) {
  const CommandResult without = run_command({armature(), "replay", file_.path(), "--port", "1"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, HasSubstr("--port requires --monitor"));
}

TEST_F(ReplayMonitor, OptionsThatWouldDoNothingAreRefused) {
  const auto refused = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {armature(), "replay", file_.path()});
    return run_command(options).exit_code == 2;
  };
  EXPECT_TRUE(refused({"--check", "--loop"}));
  EXPECT_TRUE(refused({"--check", "--from", "1"}));
  EXPECT_TRUE(refused({"--monitor", "--no-shared-memory"}));
  EXPECT_TRUE(refused({"--monitor", "--from", "nan"}));
}

}  // namespace
}  // namespace armature::test
