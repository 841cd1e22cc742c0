// SPDX-License-Identifier: Apache-2.0
// A recording that is played: what a seek shows is what was so then, nothing is lost or told twice
// at any place, and the clock is the recording's.
#include "replay/recorded_topics.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <thread>

#include "armature/recording/recorded_processes.hpp"
#include "armature/recording/recording_test.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr Time kStart{1'700'000'000'000'000'000};
constexpr int kCount = 200;  // of "/fast", one each 10 ms
constexpr int kSlow = 50;    // each of these many has one of "/slow", too

Time time_of(int number) { return kStart + number * seconds(0.01); }

/// Two seconds in many small chunks: /fast; /slow; and /static once, at the beginning.
void write(const std::filesystem::path& path) {
  McapWriter writer{path, {.chunk_bytes = 300}};
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  const auto channel = [&](const char* topic, const char* qos) {
    return writer.add(McapChannel{.schema_id = schema,
                                  .topic = topic,
                                  .message_encoding = "cdr",
                                  .metadata = {{"qos", qos}}});
  };
  const auto fast = channel("/fast", "state"), slow = channel("/slow", "state"),
             latched = channel("/static", "latched");
  const auto put = [&](std::uint16_t id, int number) {
    writer.write(id, 0, time_of(number), time_of(number),
                 std::as_bytes(std::span{&number, std::size_t{1}}));
  };
  put(latched, 0);
  for (int number = 0; number < kCount; ++number) {
    put(fast, number);
    if (number % kSlow == 0) put(slow, number);
  }
  writer.close();
}

/// A joined recording: what "main" has written to /fast, and the same as "vision" has read it.
void write_joined(const std::filesystem::path& path) {
  McapWriter writer{path, {}};
  for (const char* process : {"main", "vision"}) {
    writer.add(
        McapMetadata{.name = std::string{kProcessMetadata}, .values = {{kProcessKey, process}}});
  }
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  for (const std::map<std::string, std::string>& metadata :
       {std::map<std::string, std::string>{{"qos", "state"}},
        {{"qos", "state"}, {kFromKey, "main"}}}) {
    const auto channel = writer.add(McapChannel{
        .schema_id = schema, .topic = "/fast", .message_encoding = "cdr", .metadata = metadata});
    for (int number = 0; number < 3; ++number) {
      writer.write(channel, 0, time_of(number), time_of(number),
                   std::as_bytes(std::span{&number, std::size_t{1}}));
    }
  }
  writer.close();
}

/// One topic as two types, each three times.
void write_two_types(const std::filesystem::path& path) {
  McapWriter writer{path, {}};
  int number = 0;
  for (const char* type : {"std_msgs/msg/String", "std_msgs/msg/Int32"}) {
    const auto schema =
        writer.add(McapSchema{.name = type, .encoding = "ros2msg", .data = "# as there\n"});
    const auto channel =
        writer.add(McapChannel{.schema_id = schema, .topic = "/both", .message_encoding = "cdr"});
    for (int i = 0; i < 3; ++i, ++number) {
      writer.write(channel, 0, time_of(number), time_of(number),
                   std::as_bytes(std::span{&number, std::size_t{1}}));
    }
  }
  writer.close();
}

class RecordedTopicsTest : public testing::Test {
 protected:
  RecordedTopicsTest() { write(file_.path()); }

  void open(const RecordedTopics::Options& options = {}) {
    recording_.emplace(file_.path(), options);
  }
  void watch(const std::string& topic) {
    recording_->watch(topic, [this, topic](const TopicSource::Message& message) {
      int number = -1;
      std::memcpy(&number, message.cdr.data(), sizeof number);
      EXPECT_EQ(message.time, time_of(number));
      told_[topic].push_back(number);
    });
  }
  std::vector<int> told(const std::string& topic) { return std::exchange(told_[topic], {}); }
  /// True when something jumped.
  bool play_to_the_end() {
    bool jumped = false;
    while (recording_->state().status == Playback::Status::playing) {
      const Playback::Advance advance = recording_->advance();
      jumped = jumped || advance.jumped;
      std::this_thread::sleep_for(std::min<Duration>(advance.next, seconds(0.002)));
    }
    return jumped;
  }
  static std::vector<int> from(int first) {
    std::vector<int> numbers;
    for (int number = first; number < kCount; ++number) numbers.push_back(number);
    return numbers;
  }

  RecordingFile file_{"played"};
  std::optional<RecordedTopics> recording_;
  std::map<std::string, std::vector<int>> told_;
};

TEST_F(RecordedTopicsTest, WaitsAtItsBeginningUntilSomebodyWatches) {
  open();
  EXPECT_EQ(recording_->first(), kStart);
  EXPECT_EQ(recording_->last(), time_of(kCount - 1));
  recording_->advance();
  EXPECT_EQ(recording_->state(),
            (Playback::State{.status = Playback::Status::paused, .at = kStart, .speed = 1}));
  watch("/fast");
  EXPECT_EQ(recording_->state().status, Playback::Status::playing);
}

TEST_F(RecordedTopicsTest, HasItsTopicsWithTheTypesThatTheFileTells) {
  open();
  const auto topics = recording_->topics();
  ASSERT_EQ(topics.size(), 3U);
  EXPECT_EQ(topics[0].name, "/fast");
  EXPECT_EQ(topics[0].keeps, 1U);
  EXPECT_EQ(topics[2].name, "/static");
  EXPECT_EQ(topics[2].keeps, 100U);
  EXPECT_EQ(recording_->schema_of(topics[0]).name, "std_msgs/msg/String");
  EXPECT_EQ(recording_->schema_of(topics[0]).text, "string data\n");
}

TEST_F(RecordedTopicsTest, TellsEveryMessageOnceAndInOrderAtItsSpeed) {
  open({.rate = 10});
  const auto begin = std::chrono::steady_clock::now();
  watch("/fast");
  play_to_the_end();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(told("/fast"), from(0));
  EXPECT_GE(took.count(), 0.199);  // and a busy machine takes longer
  EXPECT_EQ(recording_->state().status, Playback::Status::ended);
  EXPECT_EQ(recording_->state().at, recording_->last());
}

TEST_F(RecordedTopicsTest, ASeekTellsWhatWasSoThen) {
  open();
  watch("/fast");
  watch("/slow");
  watch("/static");
  told_.clear();
  EXPECT_TRUE(recording_->request({.plays = false, .seek = time_of(120) + seconds(0.004)}));
  EXPECT_THAT(told("/fast"), ElementsAre(120));
  EXPECT_THAT(told("/slow"), ElementsAre(100));
  EXPECT_THAT(told("/static"), ElementsAre(0));
  EXPECT_EQ(recording_->state().at, time_of(120) + seconds(0.004));
  recording_->advance();
  EXPECT_THAT(told("/fast"), IsEmpty()) << "it is paused";
  EXPECT_FALSE(recording_->request({.plays = true, .speed = 10}));
  play_to_the_end();
  EXPECT_EQ(told("/fast"), from(121));
}

TEST_F(RecordedTopicsTest, WhereverOneSeeksOrBeginsToWatchNothingIsLostOrToldTwice) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u\n", seed);
  std::mt19937 random{seed};
  open();
  watch("/fast");
  for (int i = 0; i < 300; ++i) {
    const int number = static_cast<int>(random() % kCount);
    recording_->request({.plays = false, .seek = time_of(number)});
    told_.clear();
    watch("/slow");  // reads elsewhere in the file
    EXPECT_THAT(told("/slow"), ElementsAre(number / kSlow * kSlow));
    recording_->unwatch("/slow");
    recording_->request({.plays = true, .speed = 1e6F});
    play_to_the_end();
    ASSERT_EQ(told("/fast"), from(number + 1)) << "from " << number;
  }
}

TEST_F(RecordedTopicsTest, ASeekOutsideOfTheRecordingGoesToItsEnds) {
  open();
  watch("/fast");
  told_.clear();
  recording_->request({.plays = false, .seek = Time{-5}});
  EXPECT_EQ(recording_->state().at, recording_->first());
  recording_->request({.plays = false, .seek = Time{std::numeric_limits<std::int64_t>::max()}});
  EXPECT_EQ(recording_->state().at, recording_->last());
  EXPECT_THAT(told("/fast"), ElementsAre(0, kCount - 1));
}

TEST_F(RecordedTopicsTest, ASpeedThatIsNoneChangesNothing) {
  open({.rate = 2});
  for (const float speed : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
    recording_->request({.plays = false, .speed = speed});
    EXPECT_EQ(recording_->state().speed, 2);
  }
}

TEST_F(RecordedTopicsTest, PlayedAtItsEndItBeginsAgain) {
  open({.rate = 1000});
  watch("/fast");
  play_to_the_end();
  told_.clear();
  EXPECT_FALSE(recording_->request({.plays = false, .speed = 1000})) << "a pause leaves it there";
  EXPECT_EQ(recording_->state().status, Playback::Status::ended);
  EXPECT_TRUE(recording_->request({.plays = true, .speed = 1000}));
  play_to_the_end();
  EXPECT_EQ(told("/fast"), from(0));
}

TEST_F(RecordedTopicsTest, ALoopBeginsAgainWhereItBegan) {
  open({.rate = 1000, .from = seconds(1), .loop = true});
  watch("/fast");
  play_to_the_end();
  told_.clear();
  EXPECT_TRUE(recording_->advance().jumped);
  EXPECT_THAT(told("/fast"), ElementsAre(100));
  EXPECT_EQ(recording_->state().status, Playback::Status::playing);
}

TEST_F(RecordedTopicsTest, ATopicWithTwoTypesIsShownAsTheFirstOneAndTheOtherOneIsNamed) {
  write_two_types(file_.path());
  open({.rate = 10});
  ASSERT_EQ(recording_->topics().size(), 1U);
  EXPECT_EQ(recording_->schema_of(recording_->topics()[0]).name, "std_msgs/msg/String");
  EXPECT_THAT(recording_->problems(),
              ElementsAre(HasSubstr("'/both' has messages of two types: it is shown as "
                                    "'std_msgs/msg/String', and those of 'std_msgs/msg/Int32'")));
  watch("/both");
  play_to_the_end();
  EXPECT_THAT(told("/both"), ElementsAre(0, 1, 2));
}

TEST_F(RecordedTopicsTest, RefusesABeginningBehindItsEnd) {
  EXPECT_THAT(test::refusal_of([&] { open({.from = seconds(3)}); }),
              HasSubstr("is 1.99 s long: nothing is there from 3 s on"));
}

TEST_F(RecordedTopicsTest, WhatIsRecordedByWriterAndReaderIsToldOnce) {
  write_joined(file_.path());
  open();
  watch("/fast");
  recording_->request({.plays = true, .speed = 1000});
  for (int i = 0; i < 2000 && recording_->state().status != Playback::Status::ended; ++i) {
    recording_->advance();
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  EXPECT_THAT(told("/fast"), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace armature
