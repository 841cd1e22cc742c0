// SPDX-License-Identifier: Apache-2.0
// What was recorded is published again, and what cannot be is told.
#include <csignal>
#include <cstddef>
#include <cstdint>

#include "armature/recording/mcap_writer.hpp"
#include "replay_test.hpp"

namespace armature::test {
namespace {

using ::testing::HasSubstr;

TEST_F(Replay, WhatWasRecordedIsPublishedAgainUnderNamesOfItsOwn) {
  record_shortly();
  const std::string domain = std::to_string(unique_dds_domain());
  Command playing{{armature(), "replay", file(), "--loop", "--rate", "2", "--domain", domain}};
  const CommandResult joints =
      run_command({armature(), "topic", "echo", "/replay/dental_lamp/arm/measured_js", "-n", "1",
                   "--timeout", "20", "--domain", domain});
  EXPECT_EQ(joints.exit_code, 0) << joints.err;
  EXPECT_THAT(joints.out, HasSubstr("\"position\""));
  const CommandResult description =
      run_command({armature(), "topic", "echo", "/replay/dental_lamp/description", "-n", "1",
                   "--timeout", "20", "--domain", domain});
  EXPECT_THAT(description.out, HasSubstr("ik/lamp_geometric")) << "also for those who come later";
  playing.signal(SIGINT);
  const CommandResult played = playing.finish(kEnough);
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.out, HasSubstr("topics under /replay"));
}

TEST_F(Replay, AGapIsToldWithTheTimeForWhichNothingWasRecorded) {
  record_needle();
  const CommandResult replay =
      run_command({armature(), "replay", file(), "--rate", "1e-5", "--timeout", "3", "--domain",
                   std::to_string(unique_dds_domain())});
  EXPECT_THAT(replay.err, testing::ContainsRegex("the next message comes in [0-9]+ s: none was "
                                                 "recorded for 0\\.0[0-9]+ s; a higher --rate"));
}

TEST_F(Replay, WhatCannotBePublishedIsToldWithTheReason) {
  record_needle();
  const std::string domain = std::to_string(unique_dds_domain());
  const CommandResult behind =
      run_command({armature(), "replay", file(), "--from", "100", "--loop", "--domain", domain});
  EXPECT_EQ(behind.exit_code, 3);
  EXPECT_THAT(behind.err, testing::ContainsRegex("run.mcap' is [0-9.]+ s long: nothing is there "
                                                 "from 100 s on"));
  McapWriter{file("empty.mcap"), {}}.close();
  const CommandResult empty =
      run_command({armature(), "replay", file("empty.mcap"), "--domain", domain});
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.err, HasSubstr("empty.mcap' has no messages to be published"));
}

TEST_F(Replay, OfARecordingOfAnotherProgramAllIsPublishedWhoseTypeIsKnownAndTheRestIsNamed) {
  {
    McapWriter writer{file(), {}};
    const auto channel_of = [&](const char* topic, const char* type) {
      const auto schema =
          writer.add(McapSchema{.name = type, .encoding = "ros2msg", .data = "# as there\n"});
      return writer.add(
          McapChannel{.schema_id = schema, .topic = topic, .message_encoding = "cdr"});
    };
    const auto write = [&](std::uint16_t channel, std::int64_t second, std::size_t bytes) {
      std::vector<std::byte> cdr(bytes);
      cdr[1] = std::byte{1};  // little endian
      writer.write(channel, 1, Time{second * 1'000'000'000}, Time{}, cdr);
    };
    constexpr std::size_t kFloat64 = 4 + 8, kNothing = 4;
    const auto value = channel_of("/value", "std_msgs/msg/Float64");
    for (int i = 0; i < 3; ++i) write(value, 0, kFloat64);
    write(value, 0, kNothing);
    write(channel_of("/value", "std_msgs/msg/String"), 0, kFloat64);
    write(channel_of("/a\x1b[31m", "foo/msg/Bar"), 0, kFloat64);
    write(value, 3600, kFloat64);
    writer.close();
  }
  const CommandResult played = run_command({armature(), "replay", file(), "--timeout", "3",
                                            "--domain", std::to_string(unique_dds_domain())});
  EXPECT_EQ(played.exit_code, 1) << "some were left out";
  EXPECT_THAT(played.out, HasSubstr("3 messages of 1 topics under /replay"));
  EXPECT_THAT(played.err, HasSubstr("'/value' has messages of two types: those of "));
  EXPECT_THAT(played.err, HasSubstr("1 messages of '/value' are not what their type says"));
  EXPECT_THAT(played.err, HasSubstr("is of the type 'foo/msg/Bar', which is not known here, and is "
                                    "not published; --monitor shows it. The folder of a library"));
  EXPECT_THAT(played.err, testing::Not(HasSubstr("\x1b"))) << "nothing that a terminal obeys";
  EXPECT_THAT(played.err, HasSubstr("the next message comes in 3600 s"));
}

}  // namespace
}  // namespace armature::test
