// SPDX-License-Identifier: Apache-2.0
// `armature info` counts messages, and tells what a recording holds.
#include <gmock/gmock.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "armature/recording/mcap_writer.hpp"
#include "record/record_test.hpp"

namespace armature {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Info, CountsAMessageOnceThatItsWriterAndAReaderHaveRecorded) {
  const RecordingFile file{"info"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    for (const char* process : {"main", "vision"}) {
      writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
    }
    const auto schema = writer.add(
        McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
    const auto channel_of = [&](std::map<std::string, std::string> metadata) {
      return writer.add(McapChannel{.schema_id = schema,
                                    .topic = "/a",
                                    .message_encoding = "cdr",
                                    .metadata = std::move(metadata)});
    };
    const std::vector<std::pair<std::uint16_t, int>> counts{
        {channel_of({{"process", "vision"}}), 100},
        {channel_of({{"process", "main"}, {"from", "vision"}}), 40},
        {channel_of({{"process", "main"}, {"from", "vision,desk"}}), 7}};  // desk is not in it
    for (const auto& [channel, count] : counts) {
      for (int i = 0; i < count; ++i) {
        const std::string text = payload(1);
        const Time time{10'000'000 * (i + 1)};
        writer.write(channel, static_cast<std::uint32_t>(i), time, time,
                     std::as_bytes(std::span{text}));
      }
    }
    writer.close();
  }
  for (const bool verify : {false, true}) {
    const nlohmann::json info = info_of(file.path(), verify);
    EXPECT_EQ(info["doubled"], 40) << info.dump(1);
    ASSERT_EQ(info["topics"].size(), 1U);
    EXPECT_EQ(info["topics"][0]["messages"], 107);
    EXPECT_EQ(info["topics"][0]["doubled"], 40);
    if (!verify) continue;
    EXPECT_EQ(info["topics"][0]["bytes"], 107 * payload(1).size());
  }
}

TEST(Info, TellsATopicThatHasTwoTypesOnceForEach) {
  const RecordingFile file{"info"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    int messages = 0;
    for (const char* type : {"std_msgs/msg/Float64", "std_msgs/msg/String"}) {
      const auto schema =
          writer.add(McapSchema{.name = type, .encoding = "ros2msg", .data = "# as there\n"});
      const auto channel =
          writer.add(McapChannel{.schema_id = schema, .topic = "/a", .message_encoding = "cdr"});
      messages += 10;
      for (int i = 0; i < messages; ++i) {
        const std::string text = payload(1);
        writer.write(channel, static_cast<std::uint32_t>(i), Time{i}, Time{i},
                     std::as_bytes(std::span{text}));
      }
    }
    writer.close();
  }
  for (const bool verify : {false, true}) {
    const nlohmann::json topics = info_of(file.path(), verify)["topics"];
    ASSERT_EQ(topics.size(), 2U) << topics.dump(1);
    EXPECT_EQ(topics[0]["type"], "std_msgs/msg/Float64");
    EXPECT_EQ(topics[0]["messages"], 10);
    EXPECT_EQ(topics[1]["topic"], "/a");
    EXPECT_EQ(topics[1]["messages"], 20);
  }
}

TEST(Info, SaysThatAFileIsWholeAndHowOftenATopicCameOnlyWhenItHasReadAllOfIt) {
  const RecordingFile file{"info"};
  write_part(file.path(), "main", 10);
  std::string bytes = file.bytes();
  EXPECT_EQ(info_of(file.path(), true)["whole"], true);
  EXPECT_THAT(info_text({.file = file.path(), .verify = true}, kOk), HasSubstr("500.0 Hz"));
  EXPECT_EQ(info_of(file.path(), true)["topics"][0]["hz"], 500);
  EXPECT_THAT(info_text({.file = file.path()}, kOk), Not(HasSubstr("Hz")));
  EXPECT_FALSE(info_of(file.path(), false)["topics"][0].contains("hz"));
  bytes[places_of(mcap::Op::chunk, bytes).at(1) + 60] ^= 0x01;
  file.replace(bytes);
  EXPECT_EQ(info_of(file.path(), false)["whole"], nlohmann::json{}) << "nobody has looked";
}

}  // namespace
}  // namespace armature
