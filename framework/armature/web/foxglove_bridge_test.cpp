// SPDX-License-Identifier: Apache-2.0
// What clients that mean no good cost the bridge: what they are told back, and how many
// subscriptions each has. The topics are the test's own.
#include "armature/web/foxglove_bridge.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "armature/web/web_socket.hpp"

namespace armature {
namespace {

using nlohmann::json;

/// One topic, whose messages the test writes.
class OneTopic : public TopicSource {
 public:
  std::vector<Topic> topics() const override {
    ++looks_;
    if (!is_there_) return {};
    std::vector<Topic> topics{{.name = "/light", .type = type_.load(), .keeps = 100}};
    if (is_there_twice_) topics.push_back({.name = "/light", .type = "Colour"});
    return topics;
  }
  Schema schema_of(const Topic&) const override { return {"lamp/msg/Light", "float64 lux"}; }
  bool watch(const std::string&, OnMessage on_message) override {
    const std::scoped_lock lock{mutex_};
    if (is_just_gone_.exchange(false)) return false;
    on_message_ = std::move(on_message);
    return true;
  }
  void unwatch(const std::string&) override {
    const std::scoped_lock lock{mutex_};
    on_message_ = nullptr;
  }

  void be_of_type(const char* type) { type_ = type; }
  void be_there(bool is_there) { is_there_ = is_there; }
  void be_there_twice() { is_there_twice_ = true; }
  /// Refuses the next one who watches; it is there again when the topics are asked for.
  void be_just_gone() { is_just_gone_ = true; }
  /// Returns when the topics have been asked for twice more.
  void wait_for_looks() const {
    const int last = looks_ + 2;
    while (looks_ < last) std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }

  bool write(const std::string& text, std::uint64_t lost_before = 0) {
    const std::scoped_lock lock{mutex_};
    if (!on_message_) return false;
    on_message_(
        {.time = Time{1}, .cdr = std::as_bytes(std::span{text}), .lost_before = lost_before});
    return true;
  }

 private:
  mutable std::atomic<int> looks_{0};
  std::atomic<bool> is_there_{true};
  std::atomic<bool> is_there_twice_{false};
  std::atomic<bool> is_just_gone_{false};
  std::atomic<const char*> type_{"Light"};
  std::mutex mutex_;
  OnMessage on_message_;
};

/// The same topic of a recording. It says one thing where it begins, and jumps once it is read.
class PlayedTopic final : public OneTopic, public Playback {
 public:
  bool watch(const std::string& name, OnMessage on_message) override {
    OneTopic::watch(name, std::move(on_message));
    is_read_ = true;
    return write("before");
  }

  Time first() const override { return Time{0}; }
  Time last() const override { return Time{1}; }
  State state() const override { return {}; }
  bool request(const Request&) override { return write("behind"); }
  Advance advance() override {
    const bool jumps = jumps_by_itself && std::exchange(is_read_, false);
    return {.next = Duration{0}, .jumped = jumps && write("behind")};
  }

  bool jumps_by_itself = false;

 private:
  bool is_read_ = false;
};

/// What a client of a played topic is told of its messages and of jumps once it has subscribed to
/// it, and has asked for `request`, up to the message that comes behind the jump.
std::vector<std::string> told_of(PlayedTopic& topic, const std::string& request) {
  std::atomic<bool> ends{false};
  FoxgloveBridge bridge{topic, {.server = {.protocols = {"foxglove.sdk.v1"}}, .playback = &topic}};
  std::thread thread{[&] { bridge.run([&] { return ends.load(); }); }};
  std::vector<std::string> told;
  {
    WebSocket socket{bridge.port(), "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"};
    for (auto frame = socket.next(); frame; frame = socket.next()) {
      constexpr char kMessage = 1, kState = 5;
      if (frame->op == 1) {
        const json said = json::parse(frame->payload);
        if (said["op"] != "advertise") continue;
        const json one{{"id", 1}, {"channelId", said["channels"][0]["id"]}};
        socket.send_text(json{{"op", "subscribe"}, {"subscriptions", {one}}}.dump());
        if (!request.empty()) socket.send_binary(request);
      } else if (frame->payload[0] == kMessage) {
        told.push_back(frame->payload.substr(13));
        if (told.back() == "behind") break;
      } else if (frame->payload[0] == kState && frame->payload[14] == 1) {
        told.emplace_back("jump");
      }
    }
  }
  ends = true;
  thread.join();
  return told;
}

class FoxgloveBridgeTest : public testing::Test {
 protected:
  FoxgloveBridgeTest() : thread_{[this] { bridge_.run([this] { return ends_.load(); }); }} {
    for (auto frame = socket_.next(); frame; frame = socket_.next()) {
      const json told = json::parse(frame->payload);
      if (told["op"] != "advertise") continue;
      channel_ = told["channels"][0]["id"];
      return;
    }
    ADD_FAILURE() << "the topic was not advertised";
  }
  ~FoxgloveBridgeTest() override {
    ends_ = true;
    thread_.join();
  }

  std::string answer_to(const std::string& said) {
    socket_.send_text(said);
    return told().value("message", "");
  }
  /// What the bridge tells next, but for messages of topics.
  json told() {
    for (auto frame = socket_.next(); frame; frame = socket_.next()) {
      if (frame->op == 1) return json::parse(frame->payload);
    }
    return json::object();
  }
  json subscription(int id) const { return {{"id", id}, {"channelId", channel_}}; }
  /// What the operator was told, once it is `count` lines.
  std::vector<std::string> notes(std::size_t count) {
    for (int i = 0; i < 1000; ++i) {
      {
        const std::scoped_lock lock{mutex_};
        if (notes_.size() >= count) return notes_;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    return {};
  }

  OneTopic topic_;
  std::atomic<bool> ends_{false};
  std::mutex mutex_;
  std::vector<std::string> notes_;
  FoxgloveBridge bridge_{topic_,
                         {.server = {.protocols = {"foxglove.websocket.v1"}},
                          .on_note = [this](const std::string& note) {
                            const std::scoped_lock lock{mutex_};
                            notes_.push_back(note);
                          }}};
  std::thread thread_;
  WebSocket socket_{bridge_.port(), "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"};
  int channel_ = 0;
};

TEST_F(FoxgloveBridgeTest, TellsBackTheBeginningOfWhatWasSaid) {
  EXPECT_EQ(answer_to(json{{"op", std::string(60'000, 'x')}}.dump()),
            "'" + std::string(80, 'x') + "...' is not done here: a monitor only shows");
  std::string umlauts;
  for (int i = 0; i < 81; ++i) umlauts += "ä";
  EXPECT_EQ(answer_to(json{{"op", umlauts}}.dump()),
            "'" + umlauts.substr(0, 160) + "...' is not done here: a monitor only shows");
}

TEST_F(FoxgloveBridgeTest, GivesAClientOneSubscriptionOfAChannel) {
  json many = json::array();
  for (int id = 1; id <= 1000; ++id) many.push_back(subscription(id));
  const std::string refused = answer_to(json{{"op", "subscribe"}, {"subscriptions", many}}.dump());
  EXPECT_EQ(refused, "channel " + std::to_string(channel_) +
                         " has the subscription 1 already: a channel has one of each client");
  ASSERT_TRUE(topic_.write("bright") && topic_.write("dark"));
  std::vector<std::string> messages;
  while (messages.size() < 2) {
    const auto frame = socket_.next();
    ASSERT_TRUE(frame);
    if (frame->op == 2) messages.push_back(frame->payload.substr(13));
  }
  EXPECT_EQ(messages, (std::vector<std::string>{"bright", "dark"})) << "each of them once";
}

TEST_F(FoxgloveBridgeTest, TakesNoIdForAnother) {
  const std::string range = "an id is a whole number from 0 to 4294967295, not ";
  for (const char* const id : {"4294967297", "1.5", "-1", "true", "1e300", "\"1\"", "null"}) {
    const std::string text = id, channel = std::to_string(channel_);
    const auto subscribing = [&](const std::string& number, const std::string& to) {
      return R"({"op": "subscribe", "subscriptions": [{"id": )" + number + R"(, "channelId": )" +
             to + "}]}";
    };
    for (const std::string& said :
         {subscribing(text, channel), subscribing("1", text),
          R"({"op": "unsubscribe", "subscriptionIds": [)" + text + "]}"}) {
      const std::string answer = answer_to(said);
      EXPECT_EQ(answer.substr(0, range.size()), range) << said;
    }
  }
  EXPECT_FALSE(topic_.write("bright")) << "nobody reads it";
}

TEST_F(FoxgloveBridgeTest, RefusesWhatIsNestedDeeply) {
  constexpr std::size_t kDeep = 400'000;  // 800 kB, which a client may say
  const std::string nested = std::string(kDeep, '[') + std::string(kDeep, ']');
  const std::string refused = "what was said is nested too deeply";
  EXPECT_EQ(answer_to(nested), refused);
  EXPECT_EQ(answer_to(R"({"op": "subscribe", "subscriptions": [{"id": )" + nested +
                      R"(, "channelId": 1}]})"),
            refused);
  EXPECT_EQ(answer_to(R"({"op": "unsubscribe", "subscriptionIds": [)" + nested + "]}"), refused);
  EXPECT_EQ(answer_to(std::string(kDeep, '[')), refused) << "it has no end";
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows")
      << "the bridge goes on";
}

TEST_F(FoxgloveBridgeTest, ALongListInWhatIsSaidHoldsNobodyUp) {
  std::string list = "{}";
  for (int i = 1; i < 300'000; ++i) list += ",{}";
  const auto begin = std::chrono::steady_clock::now();
  const std::string refused = answer_to(R"({"op": "subscribe", "subscriptions": [)" + list + "]}");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{5});
  EXPECT_EQ(refused.substr(0, 11), "[json.excep") << refused;
}

TEST_F(FoxgloveBridgeTest, ABracketInATextIsNoLevel) {
  const std::string brackets(20, '[');
  EXPECT_EQ(answer_to(json{{"op", "\"" + brackets}}.dump()),
            "'\"" + brackets + "' is not done here: a monitor only shows");
}

TEST_F(FoxgloveBridgeTest, QuotesNoListForANumber) {
  const std::string range = "an id is a whole number from 0 to 4294967295, not an ";
  EXPECT_EQ(answer_to(R"({"op": "unsubscribe", "subscriptionIds": [[[1]]]})"), range + "array");
  EXPECT_EQ(answer_to(R"({"op": "unsubscribe", "subscriptionIds": [{"a": 1}]})"), range + "object");
}

TEST_F(FoxgloveBridgeTest, TakesAnotherNumberOnceTheFirstIsGivenBack) {
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  socket_.send_text(R"({"op": "unsubscribe", "subscriptionIds": [1]})");
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(2)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  ASSERT_TRUE(topic_.write("bright"));
  const auto frame = socket_.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->op, 2);
  EXPECT_EQ(frame->payload[1], 2) << "the number of the subscription";
}

TEST_F(FoxgloveBridgeTest, ForgetsAChannelThatIsGoneAndNumbersItAnewWhenItComesAgain) {
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  int last = channel_;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(i > 0 || topic_.write("the last"));
    topic_.be_there(false);
    EXPECT_EQ(told(), (json{{"op", "unadvertise"}, {"channelIds", {last}}}));
    topic_.be_there(true);
    const json came = told();
    ASSERT_EQ(came["op"], "advertise");
    EXPECT_EQ(came["channels"][0]["topic"], "/light");
    EXPECT_EQ(came["channels"][0]["id"], last + 1) << "what was known of the old one is gone";
    last = came["channels"][0]["id"];
  }
  EXPECT_EQ(answer_to(json{{"op", "subscribe"}, {"subscriptions", {subscription(2)}}}.dump()),
            "there is no channel " + std::to_string(channel_));
}

TEST_F(FoxgloveBridgeTest, ReadsATopicThatWasAwayForAMomentWhenItWasAskedFor) {
  topic_.be_just_gone();
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  topic_.wait_for_looks();
  EXPECT_TRUE(topic_.write("bright"));
}

TEST_F(FoxgloveBridgeTest, KeepsOfATopicNoMoreThan16MBForThoseWhoComeLater) {
  const json subscribing{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}};
  socket_.send_text(subscribing.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  const auto next_of = [](WebSocket& socket) {
    auto frame = socket.next();
    while (frame && frame->op != 2) frame = socket.next();
    return frame ? frame->payload.substr(13, 1) : "";
  };
  for (const char name : {'a', 'b', 'c'}) {
    ASSERT_TRUE(topic_.write(std::string(7'000'000, name)));
    ASSERT_EQ(next_of(socket_), std::string(1, name));
  }
  WebSocket later{bridge_.port(), "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"};
  later.send_text(subscribing.dump());
  EXPECT_EQ(next_of(later), "b");
  EXPECT_EQ(next_of(later), "c");
}

TEST_F(FoxgloveBridgeTest, OffersTheFirstOfTwoTopicsOfOneName) {
  topic_.be_there_twice();
  topic_.wait_for_looks();
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows")
      << "nothing was told of the second";
  topic_.be_there(false);
  EXPECT_EQ(told(), (json{{"op", "unadvertise"}, {"channelIds", {channel_}}}));
  topic_.be_there(true);
  const json came = told();
  ASSERT_EQ(came["channels"].size(), 1U);
  EXPECT_EQ(came["channels"][0]["id"], channel_ + 1);
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
}

TEST_F(FoxgloveBridgeTest, TellsAClientHowManyMessagesDidNotArrive) {
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  ASSERT_TRUE(topic_.write("bright", 3));
  EXPECT_EQ(told().value("message", ""), "3 messages were lost on the way to the bridge");
  WebSocket later{bridge_.port(), "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"};
  ASSERT_TRUE(topic_.write("dark", 1));
  EXPECT_EQ(told().value("message", ""), "1 messages were lost on the way to the bridge");
  later.send_text(R"({"op": "end"})");
  for (auto frame = later.next(); frame; frame = later.next()) {
    const json said = json::parse(frame->payload);
    if (said["op"] != "status") continue;
    EXPECT_EQ(said["message"], "'end' is not done here: a monitor only shows")
        << "it reads no topic";
    break;
  }
}

TEST_F(FoxgloveBridgeTest, TellsTheOperatorOfLostMessagesAtFirstAndWhenTheirNumberHasADigitMore) {
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  for (const std::uint64_t lost : {3, 1, 20}) {
    ASSERT_TRUE(topic_.write("bright", lost));
    EXPECT_EQ(told().value("op", ""), "status") << "it has been told before the next are lost";
  }
  EXPECT_EQ(notes(2), (std::vector<std::string>{"3 messages were lost on the way to the bridge",
                                                "24 messages were lost on the way to the bridge"}));
}

TEST_F(FoxgloveBridgeTest, TellsTheOperatorOfAClientThatReadsTooSlowly) {
  socket_.send_text(json{{"op", "subscribe"}, {"subscriptions", {subscription(1)}}}.dump());
  EXPECT_EQ(answer_to(R"({"op": "end"})"), "'end' is not done here: a monitor only shows");
  for (int i = 0; i < 10 && notes(0).empty(); ++i) {
    for (int mb = 0; mb < 10; ++mb) ASSERT_TRUE(topic_.write(std::string(1'000'000, 'x')));
    topic_.wait_for_looks();
  }
  const std::vector<std::string> told = notes(1);
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(told[0].ends_with(" messages were dropped: they came faster than client 1 reads"))
      << told[0];
}

TEST(FoxgloveBridgePlaybackTest, SendsNothingFromBeforeAJumpBehindIt) {
  const std::vector<std::string> in_order{"before", "jump", "behind"};
  PlayedTopic asked;
  std::string seek(19, '\0');  // to 0, at the speed that it has
  seek[0] = 3;
  seek[6] = 1;
  EXPECT_EQ(told_of(asked, seek), in_order);
  PlayedTopic jumping;
  jumping.jumps_by_itself = true;
  EXPECT_EQ(told_of(jumping, ""), in_order);
}

TEST_F(FoxgloveBridgeTest, OffersATopicAnewThatHasAnotherType) {
  topic_.be_of_type("Colour");
  EXPECT_EQ(told(), (json{{"op", "unadvertise"}, {"channelIds", {channel_}}}));
  const json came = told();
  ASSERT_EQ(came["op"], "advertise");
  EXPECT_EQ(came["channels"][0]["id"], channel_ + 1);
}

}  // namespace
}  // namespace armature
