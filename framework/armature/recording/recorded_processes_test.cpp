// SPDX-License-Identifier: Apache-2.0
// A joined recording: 'aside' writes /coin, and 'main' has recorded what it read of it.
#include "armature/recording/recorded_processes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recording_test.hpp"

namespace armature {
namespace {

class RecordedCopiesTest : public testing::Test {
 protected:
  /// 'aside' has recorded its first three messages, 'main' the first five, 'desk' the first four.
  void write(const std::vector<std::string>& ended, bool is_numbered = true) {
    McapWriter writer{file_.path(), {}};
    for (const char* process : {"main", "aside", "desk"}) {
      writer.add(
          McapMetadata{.name = std::string{kProcessMetadata}, .values = {{kProcessKey, process}}});
    }
    for (const std::string& process : ended) {
      writer.add(
          McapMetadata{.name = std::string{kEndMetadata}, .values = {{kProcessKey, process}}});
    }
    std::map<std::string, std::string> of_copy{{kProcessKey, "main"}, {kFromKey, "aside"}};
    if (is_numbered) of_copy[kNumberedKey] = "by its writer";
    put(writer, {{kProcessKey, "aside"}}, 3);
    put(writer, of_copy, 5);
    of_copy[kProcessKey] = "desk";
    put(writer, of_copy, 4);
    writer.close();
  }
  /// The numbers of the messages that a player of the file plays.
  std::vector<std::uint32_t> played() const {
    const RecordedCopies copies{file_.path()};
    McapReader reader{file_.path()};
    std::vector<std::uint32_t> numbers;
    while (const auto message = reader.next()) {
      if (!copies.has(*message)) numbers.push_back(message->sequence);
    }
    return numbers;
  }

  RecordingFile file_{"joined"};

 private:
  static void put(McapWriter& writer, const std::map<std::string, std::string>& metadata,
                  std::uint32_t count) {
    const auto channel =
        writer.add(McapChannel{.topic = "/coin", .message_encoding = "cdr", .metadata = metadata});
    for (std::uint32_t number = 1; number <= count; ++number) {
      const Time time{number};
      writer.write(channel, number, time, time, std::as_bytes(std::span{"coin"}));
    }
  }
};

using Numbers = std::vector<std::uint32_t>;

TEST_F(RecordedCopiesTest, AreAllThatCameFromAProcessWhoseRecordingIsWhole) {
  write({"main", "aside", "desk"});
  EXPECT_EQ(played(), (Numbers{1, 2, 3}));
  EXPECT_TRUE(RecordedCopies{file_.path()}.are_whole_channels());
}

TEST_F(RecordedCopiesTest, OfAProcessThatWasKilledAreWhatItsOwnRecordingStillHas) {
  write({"main", "desk"});
  EXPECT_EQ(played(), (Numbers{1, 2, 3, 4, 5})) << "each once";
  EXPECT_FALSE(RecordedCopies{file_.path()}.are_whole_channels());
}

TEST_F(RecordedCopiesTest, ThatTheirWriterHasNotNumberedAreAllLeftOut) {
  write({"main", "desk"}, false);
  EXPECT_EQ(played(), (Numbers{1, 2, 3}));
}

}  // namespace
}  // namespace armature
