// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string payload(int i) { return "message " + std::to_string(i) + std::string(100, 'x'); }

/// Two channels in small chunks, an attachment and metadata.
class Mcap : public testing::TestWithParam<bool> {
 protected:
  ~Mcap() override { fs::remove(file_); }

  static constexpr int kMessages = 1000;

  void write() {
    McapWriter writer{file_, {.compress = GetParam(), .chunk_bytes = 4096}};
    write_all_but_the_end(writer);
    writer.close();
  }
  static void write_all_but_the_end(McapWriter& writer) {
    const auto schema = writer.add(
        McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
    const auto a = writer.add(McapChannel{
        .schema_id = schema, .topic = "/a", .message_encoding = "cdr", .metadata = {{"k", "v"}}});
    writer.attach({.name = "lamp.yaml", .media_type = "application/yaml", .data = "armature: 1\n"});
    const auto b =
        writer.add(McapChannel{.schema_id = schema, .topic = "/b", .message_encoding = "cdr"});
    for (int i = 0; i < kMessages; ++i) {
      const std::string text = payload(i);
      writer.write(i % 3 == 0 ? b : a, static_cast<std::uint32_t>(i), Time{1000 + i}, Time{i},
                   std::as_bytes(std::span{text}));
    }
    writer.add(McapMetadata{.name = "run", .values = {{"seed", "1"}}});
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
  std::string bytes() const {
    std::ifstream stream{file_, std::ios::binary};
    return {std::istreambuf_iterator<char>{stream}, {}};
  }
  void replace(const std::string& bytes) const { std::ofstream{file_, std::ios::binary} << bytes; }

  const fs::path file_ = fs::temp_directory_path() / ("armature-" + std::to_string(getpid()) +
                                                      (GetParam() ? "-zstd.mcap" : ".mcap"));
};

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
    write_all_but_the_end(writer);
  }
  McapReader reader{file_};
  EXPECT_EQ(read_whole_messages(reader), kMessages) << "metadata ends a chunk";
  ASSERT_EQ(reader.problems().size(), 1U);
  EXPECT_TRUE(reader.problems()[0].starts_with("it ends before its summary, at byte "));
}

TEST_P(Mcap, CutOffAnywhereIsReadAsFarAsItIsWhole) {
  write();
  const std::string whole = bytes();
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
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
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
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

TEST_P(Mcap, WithSomethingBehindItsEndIsNotWhole) {
  write();
  replace(bytes() + "more");
  McapReader reader{file_};
  EXPECT_EQ(read_whole_messages(reader), kMessages);
  EXPECT_EQ(reader.problems(), std::vector<std::string>{"something stands behind its end"});
}

INSTANTIATE_TEST_SUITE_P(, Mcap, testing::Bool(), [](const auto& test) {
  return std::string{test.param ? "Zstd" : "Plain"};
});

TEST(McapWriter, TellsThatTheDiskIsFull) {
  const auto fill = [] { McapWriter writer{"/dev/full", {}}; };
  try {
    fill();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "cannot write '/dev/full': No space left on device");
  }
}

TEST(McapReader, RefusesWhatIsNoRecording) {
  EXPECT_THROW(McapReader{ARMATURE_SOURCE_DIR "/README.md"}, std::runtime_error);
  EXPECT_THROW(McapReader{"/dev/null"}, std::runtime_error);
  EXPECT_THROW(McapReader{"/nowhere.mcap"}, std::runtime_error);
}

}  // namespace
}  // namespace armature
