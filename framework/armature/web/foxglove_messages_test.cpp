// SPDX-License-Identifier: Apache-2.0
#include "armature/web/foxglove_messages.hpp"

#include <gmock/gmock.h>

#include <initializer_list>
#include <string>

namespace armature {
namespace {

using ::testing::HasSubstr;

std::string bytes_of(std::initializer_list<int> numbers) {
  std::string bytes;
  for (const int number : numbers) bytes += static_cast<char>(number);
  return bytes;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Pause, speed 1.5, seek to 100.5 s, "id": as the SDK of Foxglove writes it.
const std::string kPauseAndSeek = bytes_of({3,                                      // opcode
                                            1,                                      // pause
                                            0, 0, 0xC0, 0x3F,                       // 1.5
                                            1,                                      // it seeks
                                            0x00, 0x4D, 0x44, 0x66, 0x17, 0, 0, 0,  // [ns]
                                            2, 0, 0, 0}) +                          // of the id
                                  "id";

TEST(FoxgloveMessages, ARequestOfAPlaybackIsReadByteByByte) {
  const auto control = read_playback_control(kPauseAndSeek);
  ASSERT_TRUE(control) << control.error().text;
  EXPECT_FALSE(control->request.plays);
  EXPECT_EQ(control->request.speed, 1.5F);
  EXPECT_EQ(control->request.seek, Time{100'500'000'000});
  EXPECT_EQ(control->id, "id");
}

TEST(FoxgloveMessages, ARequestThatDoesNotSeekHasATimeAllTheSameWhichMeansNothing) {
  std::string message = kPauseAndSeek;
  message[1] = 0;
  message[6] = 0;
  const auto control = read_playback_control(message);
  ASSERT_TRUE(control) << control.error().text;
  EXPECT_TRUE(control->request.plays);
  EXPECT_EQ(control->request.seek, std::nullopt);
}

TEST(FoxgloveMessages, ARequestThatIsNoneIsRefusedWithTheReason) {
  const auto refusal = [](std::string message) {
    const auto control = read_playback_control(message);
    return control ? std::string{} : control.error().text;
  };
  for (std::size_t size = 0; size < kPauseAndSeek.size(); ++size) {
    EXPECT_NE(refusal(kPauseAndSeek.substr(0, size)), "") << size << " bytes";
  }
  std::string message = kPauseAndSeek;
  message[0] = 1;
  EXPECT_EQ(refusal(message), "a binary message with the opcode 1 is not known here");
  message = kPauseAndSeek;
  message[1] = 2;
  EXPECT_EQ(refusal(message),
            "a playback does not know the command 2, only 0 (play) and 1 (pause)");
  message = kPauseAndSeek;
  message[18] = '\x7F';  // 2 GB of id
  EXPECT_THAT(refusal(message), HasSubstr("says that it has 2130706434 bytes, and has 2"));
}

TEST(FoxgloveMessages, TheStateOfAPlaybackIsWrittenByteByByte) {
  const Playback::State state{
      .status = Playback::Status::paused, .at = Time{100'500'000'000}, .speed = 1.5F};
  EXPECT_EQ(
      text_of(playback_state_message(state, true, "id")),
      bytes_of({5, 1, 0x00, 0x4D, 0x44, 0x66, 0x17, 0, 0, 0, 0, 0, 0xC0, 0x3F, 1, 2, 0, 0, 0}) +
          "id");
  EXPECT_EQ(text_of(playback_state_message({.status = Playback::Status::ended}, false, "")),
            bytes_of({5, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3F, 0, 0, 0, 0, 0}));
}

TEST(FoxgloveMessages, TimesAndHeadsOfMessagesAreWrittenByteByByte) {
  EXPECT_EQ(text_of(time_message(Time{258})), bytes_of({2, 2, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(text_of(message_head(7, Time{258})), bytes_of({1, 7, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace armature
