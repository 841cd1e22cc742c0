// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recording_test.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(McapDeathTest, AFileThatIsMadeShorterWhileItIsReadIsNamed) {
  const RecordingFile file{"shorter"};
  {
    McapWriter writer{file.path(), {.compress = false, .chunk_bytes = 1024}};
    write_all_but_the_end(writer, 1000);
    writer.close();
  }
  const auto read = [&file] {
    McapReader reader{file.path(), true};
    reader.next();
    fs::resize_file(file.path(), 10);
    while (reader.next()) continue;
    std::exit(2);
  };
  EXPECT_EXIT(read(), testing::ExitedWithCode(1),
              "shorter.mcap' was made shorter while it was read");
}

TEST(McapDeathTest, AFileThatIsMadeShorterIsNamedWhereAProgramHasAHandlerForCrashes) {
  const RecordingFile file{"short"};
  {
    McapWriter writer{file.path(), {.compress = false, .chunk_bytes = 1024}};
    write_all_but_the_end(writer, 1000);
    writer.close();
  }
  const auto exit_of_crash = [](int) { _exit(3); };
  const auto read = [&] {
    std::signal(SIGBUS, exit_of_crash);
    McapReader reader{file.path(), true};
    fs::resize_file(file.path(), 10);
    while (reader.next()) continue;
    std::exit(2);
  };
  EXPECT_EXIT(read(), testing::ExitedWithCode(1), "short.mcap' was made shorter while it was read");
  const auto crash = [&] {
    std::signal(SIGBUS, exit_of_crash);
    const McapReader reader{file.path(), true};
    std::raise(SIGBUS);
    std::exit(2);
  };
  EXPECT_EXIT(crash(), testing::ExitedWithCode(3), "") << "which is of no file that is read";
}

/// Two channels in small chunks, an attachment and metadata.
class Mcap : public testing::TestWithParam<bool> {
 protected:
  static constexpr int kMessages = 1000;

  void write() {
    McapWriter writer{file_, {.compress = GetParam(), .chunk_bytes = 4096}};
    write_all_but_the_end(writer, kMessages);
    writer.close();
  }
  /// How many messages are read; each must be the one that was written.
  static int read_whole_messages(McapReader& reader) {
    int count = 0;
    while (const auto message = reader.next()) {
      EXPECT_EQ(text_of(message->data), payload(count));
      EXPECT_EQ(message->sequence, static_cast<std::uint32_t>(count));
      EXPECT_EQ(message->log_time, Time{1000 + count});
      EXPECT_EQ(message->publish_time, Time{count});
      EXPECT_EQ(message->channel->topic, count % 3 == 0 ? "/b" : "/a");
      ++count;
    }
    return count;
  }
  std::string bytes() const { return recording_.bytes(); }
  void replace(const std::string& bytes) const { recording_.replace(bytes); }

  const RecordingFile recording_{GetParam() ? "zstd" : "plain"};
  const fs::path file_ = recording_.path();
};

TEST_P(Mcap, HasOneWriterAtATime) {
  write();
  const std::string before = bytes();
  std::optional<McapWriter> first{std::in_place, file_, McapWriter::Options{}};
  write_all_but_the_end(*first, kMessages);
  try {
    McapWriter second{file_, {}};
    ADD_FAILURE() << "both write " << file_;
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string{error.what()},
              "'" + file_.string() + "' is being written by another program");
  }
  first->close();
  McapReader reader{file_};
  EXPECT_EQ(read_whole_messages(reader), kMessages);
  EXPECT_EQ(reader.problems(), std::vector<std::string>{});
  write();
  EXPECT_EQ(bytes(), before) << "a file that was closed may be replaced";
}

TEST_P(Mcap, IsReadAsItWasWritten) {
  write();
  McapReader reader{file_};
  EXPECT_EQ(read_whole_messages(reader), kMessages);
  EXPECT_EQ(reader.problems(), std::vector<std::string>{});
  ASSERT_EQ(reader.schemas().size(), 1U);
  EXPECT_EQ(reader.schemas().begin()->second.data, "string data\n");
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachments()[0].data, "armature: 1\n");
  ASSERT_EQ(reader.metadata().size(), 1U);
  EXPECT_EQ(reader.metadata()[0].values.at("seed"), "1");
  EXPECT_EQ(reader.channels().at(0).metadata.at("k"), "v");
  EXPECT_GT(reader.chunks(), 10U);
  EXPECT_EQ(reader.packed_bytes() < reader.unpacked_bytes(), GetParam());
}

TEST_P(Mcap, WithoutItsEndIsReadToItsLastChunk) {
  {
    McapWriter writer{file_, {.compress = GetParam(), .chunk_bytes = 4096}};
    write_all_but_the_end(writer, kMessages);
  }
  McapReader reader{file_};
  EXPECT_EQ(read_whole_messages(reader), kMessages) << "metadata ends a chunk";
  ASSERT_EQ(reader.problems().size(), 1U);
  EXPECT_TRUE(reader.problems()[0].starts_with("it ends before its summary, at byte "));
}

TEST_P(Mcap, CutOffAnywhereIsReadAsFarAsItIsWhole) {
  write();
  const std::string whole = bytes();
  const Seed seed;
  std::mt19937 random = seed.generator();
  int last = 0;
  std::vector<std::size_t> lengths;
  for (int i = 0; i < 100; ++i) {
    lengths.push_back(std::uniform_int_distribution<std::size_t>{8, whole.size() - 1}(random));
  }
  std::ranges::sort(lengths);
  for (const std::size_t length : lengths) {
    replace(whole.substr(0, length));
    McapReader reader{file_};
    const int count = read_whole_messages(reader);
    EXPECT_GE(count, last) << "more of the file, no fewer messages";
    EXPECT_FALSE(reader.problems().empty()) << length;
    last = count;
  }
}

TEST_P(Mcap, WithAChangedByteIsNotTakenForWhole) {
  write();
  const std::string whole = bytes();
  const Seed seed;
  std::mt19937 random = seed.generator();
  for (int i = 0; i < 300; ++i) {
    std::string changed = whole;
    changed[std::uniform_int_distribution<std::size_t>{8, whole.size() - 1}(random)] ^= 0x10;
    replace(changed);
    try {
      McapReader reader{file_};
      while (reader.next()) continue;
      EXPECT_FALSE(reader.problems().empty());
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string{error.what()}.find(" is packed with '"), std::string::npos);
    }
  }
}

TEST_P(Mcap, WithADamagedChunkLosesThatChunkOnly) {
  write();
  std::string changed = bytes();
  changed[changed.size() / 2] ^= 0x01;
  replace(changed);
  McapReader reader{file_};
  int count = 0;
  std::uint32_t last = 0;
  while (const auto message = reader.next()) {
    ++count;
    last = message->sequence;
  }
  EXPECT_GE(reader.problems().size(), 1U);
  EXPECT_GT(count, kMessages - 50);
  EXPECT_EQ(last, kMessages - 1U) << "what comes after it is read";
}

TEST_P(Mcap, WithADamagedChunkThatTellsItsChannelsKnowsThemFromItsSummary) {
  write();
  const std::string whole = bytes();
  const std::size_t first = places_of(mcap::Op::chunk, whole).front();
  std::string changed = whole;
  changed[first + 100] ^= 0x01;
  replace(changed);
  McapReader reader{file_};
  int count = 0;
  while (const auto message = reader.next()) {
    EXPECT_EQ(message->channel->topic, message->sequence % 3 == 0 ? "/b" : "/a");
    ++count;
  }
  EXPECT_GT(count, kMessages - 50);
  EXPECT_EQ(reader.schemas().at(1).name, "std_msgs/msg/String");
  const std::string damaged = "the chunk at byte " + std::to_string(first);
  ASSERT_EQ(reader.problems().size(), 3U);
  EXPECT_EQ(reader.problems()[0].substr(0, damaged.size()), damaged);
  EXPECT_EQ(reader.problems()[1],
            "what is not told of its channels where they begin is in its summary");
  EXPECT_EQ(reader.problems()[2], "the checksum of its messages is wrong: it was changed");

  replace(changed.substr(0, places_of(mcap::Op::data_end, whole).front()));
  McapReader cut{file_};
  while (const auto message = cut.next()) {
    EXPECT_EQ(message->channel->topic, "/b") << "without its summary nobody knows the other one";
  }
}

TEST(McapWriter, TellsOfAPipeThatNobodyReadsAndDoesNotWait) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  try {
    McapWriter{pipe, {}};
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "cannot write '" + pipe + "': it is a pipe that nobody reads");
  }
}

TEST_P(Mcap, WithSomethingBehindItsEndIsNotWhole) {
  write();
  const std::string whole = bytes();
  for (const auto& [more, what] :
       {std::pair{std::string{"more"}, "something"}, {whole, "another recording"}}) {
    replace(whole + more);
    McapReader reader{file_};
    EXPECT_EQ(read_whole_messages(reader), kMessages);
    EXPECT_THAT(reader.problems(),
                testing::ElementsAre(fmt::format("{} of {} bytes stands behind its end, at byte "
                                                 "{}, and is not read",
                                                 what, more.size(), whole.size())));
  }
}

INSTANTIATE_TEST_SUITE_P(, Mcap, testing::Bool(), [](const auto& test) {
  return std::string{test.param ? "Zstd" : "Plain"};
});

TEST(McapWriter, WritesForItsUserAloneAlsoWhereAFileWasBefore) {
  using std::filesystem::perms;
  const RecordingFile file{"private"};
  file.replace("for all");
  std::filesystem::permissions(
      file.path(), perms::owner_read | perms::owner_write | perms::group_read | perms::others_read);
  for (const bool is_there : {true, false}) {
    if (!is_there) std::filesystem::remove(file.path());
    McapWriter{file.path(), {}}.close();
    EXPECT_EQ(std::filesystem::status(file.path()).permissions(),
              perms::owner_read | perms::owner_write);
  }
}

TEST(McapWriter, TellsThatTheDiskIsFull) {
  const auto fill = [] { McapWriter writer{"/dev/full", {}}; };
  try {
    fill();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "cannot write '/dev/full': No space left on device");
  }
}

/// What a reader says of records that a wrong program wrote.
std::vector<std::string> problems_of(const std::string& records) {
  const RecordingFile file{"raw"};
  file.replace(RawMcap::file(records));
  McapReader reader{file.path()};
  while (reader.next()) continue;
  return reader.problems();
}

const std::string kNoMap = RawMcap::number(std::uint32_t{0});
const std::string kChannel = RawMcap::schema(1) + RawMcap::channel(2, 1, kNoMap);
using Problems = std::vector<std::string>;

TEST(McapReader, FindsNothingWrongWithWhatIsRight) {
  EXPECT_EQ(problems_of(RawMcap::chunk(5, 7, kChannel + RawMcap::message(2, 6))), Problems{});
}

TEST(McapReader, TellsLogTimesThatTheirChunkDoesNotHave) {
  EXPECT_EQ(problems_of(RawMcap::chunk(5, 7,
                                       kChannel + RawMcap::message(2, 6) + RawMcap::message(2, 4) +
                                           RawMcap::message(2, 8'000))),
            (Problems{"message 2 of the chunk at byte 29, of '/b', has the log time 4 ns, and the "
                      "chunk says that its times are from 5 to 7 ns",
                      "message 3 of the chunk at byte 29, of '/b', has the log time 8000 ns, and "
                      "the chunk says that its times are from 5 to 7 ns"}));
  EXPECT_EQ(problems_of(RawMcap::chunk(5, 7, kChannel + RawMcap::message(2, 1ULL << 63))),
            Problems{"message 1 of the chunk at byte 29, of '/b', has the log time "
                     "9223372036854775808 ns, which no clock tells"});
  EXPECT_EQ(problems_of(RawMcap::chunk(7, 5, "")),
            Problems{"the chunk at byte 29 says that its times are from 7 to 5 ns"});
}

TEST(McapReader, TellsCdrOfWhichNoSchemaSaysWhatItIs) {
  EXPECT_EQ(
      problems_of(RawMcap::chunk(
          5, 7, RawMcap::channel(3, 0, kNoMap) + RawMcap::message(3, 6) + RawMcap::message(3, 6))),
      Problems{"channel 3, '/b', is of encoding cdr and names no schema"});
  EXPECT_EQ(
      problems_of(RawMcap::chunk(5, 7, RawMcap::channel(3, 9, kNoMap) + RawMcap::message(3, 6))),
      Problems{"channel 3, '/b', is of encoding cdr and names schema 9, which is not there"});
}

TEST(McapReader, TellsAMapOfWrongLength) {
  const std::string entry = RawMcap::text("key") + RawMcap::text("value");
  const auto metadata = [&](std::uint32_t length) {
    return RawMcap::record(RawMcap::kMetadata,
                           RawMcap::text("run") + RawMcap::number(length) + entry);
  };
  const auto size = static_cast<std::uint32_t>(entry.size());
  EXPECT_EQ(problems_of(metadata(size)), Problems{});
  for (const std::uint32_t wrong : {std::uint32_t{0}, size - 1, size + 1, ~std::uint32_t{0}}) {
    EXPECT_EQ(problems_of(metadata(wrong)),
              Problems{"the metadata at byte 29 has a map of 16 bytes that says it has " +
                       std::to_string(wrong)});
    EXPECT_EQ(
        problems_of(RawMcap::schema(1) + RawMcap::channel(2, 1, RawMcap::number(wrong) + entry)),
        Problems{"a channel at byte 75 is broken, or has a map of wrong length"});
  }
}

TEST(McapReader, KeepsToWhatAChannelOrASchemaWasFirstSaidToBe) {
  const std::string chunk = RawMcap::chunk(5, 7, kChannel + RawMcap::message(2, 6));
  EXPECT_EQ(problems_of(chunk + chunk), Problems{}) << "said twice alike";
  const RecordingFile file{"raw"};
  file.replace(RawMcap::file(
      chunk + RawMcap::chunk(5, 7, RawMcap::channel(2, 1, kNoMap, "/c") + RawMcap::message(2, 6))));
  McapReader reader{file.path()};
  int messages = 0;
  for (; const auto message = reader.next(); ++messages) EXPECT_EQ(message->channel->topic, "/b");
  EXPECT_EQ(messages, 2);
  EXPECT_EQ(reader.problems(), Problems{"channel 2 is told twice: at byte 189 it is '/c', and "
                                        "before it was '/b', which counts"});
  EXPECT_EQ(
      problems_of(RawMcap::schema(1) +
                  RawMcap::record(RawMcap::kSchema,
                                  RawMcap::number(std::uint16_t{1}) + RawMcap::text("a/msg/C") +
                                      RawMcap::text("ros2msg") + RawMcap::text("bool data"))),
      Problems{"schema 1 is told twice: at byte 75 it is 'a/msg/C', and before it was "
               "'a/msg/B', which counts"});
}

TEST(McapReader, TellsWhatDiffersOfAChannelOrASchemaThatKeepsItsName) {
  const auto schema = [](const std::string& encoding, const std::string& data) {
    return RawMcap::record(RawMcap::kSchema, RawMcap::number(std::uint16_t{1}) +
                                                 RawMcap::text("a/msg/B") +
                                                 RawMcap::text(encoding) + RawMcap::text(data));
  };
  EXPECT_EQ(problems_of(RawMcap::schema(1) + schema("ros2msg", "int8 data")),
            Problems{"schema 1, 'a/msg/B', is told twice: at byte 75 it has another text than "
                     "before, and what was before counts"});
  EXPECT_EQ(problems_of(RawMcap::schema(1) + schema("ros2idl", "int8 data")),
            Problems{"schema 1, 'a/msg/B', is told twice: at byte 75 it has another encoding and "
                     "another text than before, and what was before counts"});
  const std::string entry = RawMcap::text("key") + RawMcap::text("value");
  const std::string map = RawMcap::number(static_cast<std::uint32_t>(entry.size())) + entry;
  const auto again = [](const std::string& channel) {
    return problems_of(RawMcap::channel(2, 0, kNoMap) + channel);
  };
  EXPECT_EQ(again(RawMcap::channel(2, 0, map)),
            Problems{"channel 2, '/b', is told twice: at byte 59 it has other metadata than "
                     "before, and what was before counts"});
  EXPECT_EQ(again(RawMcap::channel(2, 7, map)),
            Problems{"channel 2, '/b', is told twice: at byte 59 it has another schema and other "
                     "metadata than before, and what was before counts"});
}

TEST(McapReader, RefusesWhatIsNoRecording) {
  EXPECT_THROW(McapReader{ARMATURE_SOURCE_DIR "/README.md"}, std::runtime_error);
  EXPECT_THROW(McapReader{"/dev/null"}, std::runtime_error);
  EXPECT_THROW(McapReader{"/nowhere.mcap"}, std::runtime_error);
}

}  // namespace
}  // namespace armature
