// SPDX-License-Identifier: Apache-2.0
// The chain of hashes: 1. of what was closed it says whole, 2. of what was cut off how far it is
// right, 3. of what was changed where; 4. no byte can be changed unseen, and 5. nothing that is
// done to a file stops the reader or makes it take memory.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <random>
#include <stdexcept>

#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;
using Verdict = McapChain::Verdict;

/// What is said of a file that was read to its end.
struct Read {
  McapChain chain;
  std::vector<std::string> problems;
  int messages = 0;

  bool is_whole() const { return chain.verdict == Verdict::whole && problems.empty(); }
};

Read read(const std::filesystem::path& file) {
  McapReader reader{file, true};
  Read read;
  while (reader.next()) ++read.messages;
  read.chain = reader.chain();
  read.problems = reader.problems();
  return read;
}

class Chain : public testing::TestWithParam<bool> {
 protected:
  /// Of some 5 kB.
  void write(bool close = true) {
    McapWriter writer{file_.path(), {.compress = GetParam(), .chunk_bytes = 1024}};
    write_all_but_the_end(writer, GetParam() ? 100 : 20);
    if (close) writer.close();
    head_ = to_hex(writer.head());
    links_ = writer.links();
  }

  const RecordingFile file_{GetParam() ? "chain-zstd" : "chain-plain"};
  std::string head_;
  std::uint64_t links_ = 0;
};

TEST_P(Chain, OfARecordingThatEndedInOrderIsWhole) {
  write();
  const Read got = read(file_.path());
  EXPECT_TRUE(got.is_whole()) << testing::PrintToString(got.problems);
  EXPECT_EQ(got.chain.head, head_);
  EXPECT_EQ(got.chain.links, links_);
  EXPECT_GT(got.chain.chunks, 2U);
  EXPECT_EQ(got.chain.until, Time{1000 + got.messages - 1});
  EXPECT_EQ(got.chain.changes, std::vector<std::string>{});
}

TEST_P(Chain, OfADifferentRecordingEndsInAnotherHash) {
  write();
  const std::string first = head_;
  McapWriter writer{file_.path(), {.compress = GetParam(), .chunk_bytes = 1024}};
  write_all_but_the_end(writer, 19);
  writer.close();
  EXPECT_NE(to_hex(writer.head()), first);
}

TEST_P(Chain, IsLeftOutWhenItIsNotWanted) {
  {
    McapWriter writer{file_.path(), {.compress = GetParam(), .chain = false}};
    write_all_but_the_end(writer, 40);
    writer.close();
  }
  const Read got = read(file_.path());
  EXPECT_EQ(got.chain.verdict, Verdict::none);
  EXPECT_EQ(got.problems, std::vector<std::string>{});
}

TEST_P(Chain, OfARecordingThatDiedIsRightUpToItsLastChunk) {
  write(false);
  const Read got = read(file_.path());
  EXPECT_EQ(got.chain.verdict, Verdict::cut);
  EXPECT_EQ(got.chain.head, head_);
  EXPECT_EQ(got.chain.until, Time{1000 + got.messages - 1});
}

TEST_P(Chain, OfAFileThatIsCutAtAnyByteIsNeverWholeNorChanged) {
  write();
  const std::string whole = file_.bytes();
  std::uint64_t chunks = 0;
  for (std::size_t length = 8; length < whole.size(); ++length) {
    file_.replace(whole.substr(0, length));
    const Read got = read(file_.path());
    ASSERT_FALSE(got.is_whole()) << length;
    ASSERT_NE(got.chain.verdict, Verdict::changed) << length << " " << got.chain.changes.front();
    ASSERT_GE(got.chain.chunks, chunks) << "a longer file, no fewer chunks; " << length;
    ASSERT_LE(got.chain.bytes, length);
    chunks = got.chain.chunks;
  }
  EXPECT_GT(chunks, 2U);
}

TEST_P(Chain, NamesTheChunkThatWasChanged) {
  write();
  std::string bytes = file_.bytes();
  const std::size_t at = places_of(mcap::Op::chunk, bytes).at(2);
  bytes[at + 9 + 100] ^= 0x20;
  file_.replace(bytes);
  const Read got = read(file_.path());
  EXPECT_EQ(got.chain.verdict, Verdict::changed);
  EXPECT_THAT(got.chain.changes, ElementsAre(MatchesRegex("chunk 3, within the [0-9]+ bytes from "
                                                          "byte " +
                                                          std::to_string(at))));
  EXPECT_EQ(got.chain.links, links_) << "the links behind it are right";
}

TEST_P(Chain, FindsEveryByteThatIsChanged) {
  write();
  const std::string whole = file_.bytes();
  const Seed seed;
  std::mt19937 random = seed.generator();
  int locked = 0;
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(
        static_cast<unsigned char>(changed[at]) ^
        static_cast<unsigned char>(std::uniform_int_distribution<int>{1, 255}(random)));
    file_.replace(changed);
    const Read got = read(file_.path());
    ASSERT_FALSE(got.is_whole()) << "byte " << at;
    locked += got.chain.verdict == Verdict::changed ? 1 : 0;
  }
  constexpr int kChecked = 4 + 8 + 8;  // the last checksum, and the words that begin and end a file
  EXPECT_GE(locked, static_cast<int>(whole.size()) - kChecked);
}

TEST_P(Chain, FindsAChunkThatIsMissingOrStandsTwice) {
  write();
  const std::string whole = file_.bytes();
  // From the end of one link to the end of the next: what can be taken out with all its hashes.
  const auto bytes = std::as_bytes(std::span{whole});
  std::vector<std::size_t> ends;
  for (std::size_t at = 0; const auto next = ChainRecord::find(bytes.subspan(at));) {
    at += *next + ChainRecord{}.bytes().size();
    ends.push_back(at);
  }
  ASSERT_GT(ends.size(), 4U);
  for (std::size_t i = 0; i + 2 < ends.size(); ++i) {
    const std::string link = whole.substr(ends[i], ends[i + 1] - ends[i]);
    file_.replace(whole.substr(0, ends[i]) + whole.substr(ends[i + 1]));
    EXPECT_EQ(read(file_.path()).chain.verdict, Verdict::changed) << "without link " << i + 2;
    file_.replace(whole.substr(0, ends[i + 1]) + link + whole.substr(ends[i + 1]));
    EXPECT_EQ(read(file_.path()).chain.verdict, Verdict::changed) << "link " << i + 2 << " twice";
  }
}

TEST_P(Chain, FindsWhatIsPutBehindItsLastLink) {
  write();
  std::string bytes = file_.bytes();
  const auto places = places_of(mcap::Op::summary_offset, bytes);
  ASSERT_FALSE(places.empty());
  const std::string statistics = RawMcap::record(0x0B, std::string(46, '\0'));
  bytes.insert(places.front(), statistics);
  const std::size_t footer = places_of(mcap::Op::footer, bytes).front();
  const auto moved = static_cast<std::uint64_t>(places.front() + statistics.size());
  bytes.replace(footer + 9 + 8, 8, RawMcap::number(moved));
  file_.replace(bytes);
  EXPECT_EQ(read(file_.path()).chain.verdict, Verdict::changed);
}

TEST_P(Chain, OfWhateverIsDoneToAFileTellsAndTakesNoMemory) {
  write();
  const std::string whole = file_.bytes();
  const Seed seed;
  std::mt19937 random = seed.generator();
  const auto among = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>{0, count - 1}(random);
  };
  const auto memory = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // [KiB]
  };
  const auto before = memory();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{3};
  while (std::chrono::steady_clock::now() < end) {
    std::string bytes = whole;
    for (std::size_t i = 1 + among(8); i > 0 && bytes.size() > 8; --i) {
      const std::size_t at = 8 + among(bytes.size() - 8);
      const std::size_t size = std::min(1 + among(64), bytes.size() - at);
      switch (among(5)) {
        case 0: bytes[at] = static_cast<char>(random()); break;
        case 1: bytes.erase(at, size); break;
        case 2: bytes.insert(at, bytes.substr(8 + among(bytes.size() - 8), size)); break;
        case 3:  // the lengths of records, and what else is a number
          for (std::size_t k = 0; k < std::min(size, std::size_t{8}); ++k) bytes[at + k] = '\xFF';
          break;
        default: bytes.resize(at + 1); break;
      }
    }
    if (bytes == whole) continue;
    file_.replace(bytes);
    try {
      EXPECT_FALSE(read(file_.path()).is_whole());
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("is packed with 'lz4'"));
    }
    try {
      static_cast<void>(read_summary(file_.path()));
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("is no MCAP file"));
    }
  }
  if (kSanitized) return;
  EXPECT_LT(memory() - before, 64 << 10) << "[KiB], for a file of 5 kB";
}

INSTANTIATE_TEST_SUITE_P(, Chain, testing::Bool(), [](const auto& test) {
  return std::string{test.param ? "Zstd" : "Plain"};
});

TEST(Summary, TellsWhatAllOfTheFileTellsAndReadsNothingElse) {
  const RecordingFile file{"summary"};
  McapWriter writer{file.path(), {.chunk_bytes = 2048}};
  write_all_but_the_end(writer, 200);
  writer.close();
  McapReader reader{file.path()};
  std::map<std::uint16_t, std::uint64_t> messages;
  while (const auto message = reader.next()) ++messages[message->channel->id];

  // What is not looked at may as well be gone.
  std::string bytes = file.bytes();
  bytes.replace(places_of(mcap::Op::chunk, bytes).front() + 9, 200, 200, '\0');
  file.replace(bytes);
  const auto summary = read_summary(file.path());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->messages, messages);
  EXPECT_EQ(summary->chunks, reader.chunks());
  EXPECT_EQ(summary->packed_bytes, reader.packed_bytes());
  EXPECT_EQ(summary->unpacked_bytes, reader.unpacked_bytes());
  EXPECT_EQ(summary->first, Time{1000});
  EXPECT_EQ(summary->last, Time{1199});
  EXPECT_EQ(summary->channels.at(0).topic, "/a");
  EXPECT_EQ(summary->schemas.at(1).name, "std_msgs/msg/String");
  ASSERT_EQ(summary->attachments.size(), 1U);
  EXPECT_EQ(summary->attachments[0].name, "lamp.yaml");
  EXPECT_EQ(summary->attachments[0].bytes, 12U);
  ASSERT_EQ(summary->metadata.size(), 1U);
  EXPECT_EQ(summary->metadata[0].values.at("seed"), "1");
  EXPECT_EQ(summary->links, writer.links());
  EXPECT_EQ(summary->head, to_hex(writer.head()));
}

/// CRC-32 as MCAP has it.
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = ~std::uint32_t{0};
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// The same file with a record of its summary made anew, or left out: `edit` returns none.
std::string with_summary(const std::string& file,
                         const std::function<std::string(mcap::Op, const std::string&)>& edit) {
  constexpr std::size_t kHead = 9, kDataEnd = 13, kNumber = 8;
  const std::size_t begin = places_of(mcap::Op::data_end, file).front() + kDataEnd;
  const std::size_t end = places_of(mcap::Op::footer, file).back();
  std::string summary;
  for (std::size_t at = begin; at < end;) {
    std::uint64_t size = 0;
    std::memcpy(&size, &file[at + 1], sizeof size);
    const auto op = static_cast<mcap::Op>(file[at]);
    if (op != mcap::Op::summary_offset) summary += edit(op, file.substr(at, kHead + size));
    at += kHead + size;
  }
  summary += file.substr(end, kHead + kNumber) + std::string(kNumber, '\0');
  return file.substr(0, begin) + summary + RawMcap::number(crc_of(summary)) +
         std::string{mcap::kMagic};
}

TEST(Summary, IsNotEnoughWithoutTheCountsAndChannelsThatAWriterMayLeaveOut) {
  const RecordingFile file{"summary"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 2048, .chain = false}};
    write_all_but_the_end(writer, 200);
    writer.close();
  }
  const std::string whole = file.bytes();
  const auto has_enough = [&](const auto& edit) {
    file.replace(with_summary(whole, edit));
    McapReader reader{file.path()};
    while (reader.next()) continue;
    EXPECT_TRUE(reader.problems().empty()) << "it is a file as any";
    return read_summary(file.path()).has_value();
  };
  EXPECT_TRUE(has_enough([](mcap::Op, const std::string& record) { return record; }));
  for (const mcap::Op left_out : {mcap::Op::schema, mcap::Op::channel, mcap::Op::statistics}) {
    EXPECT_FALSE(has_enough([&](mcap::Op op, const std::string& record) {
      return op == left_out ? std::string{} : record;
    })) << static_cast<int>(left_out);
  }
  EXPECT_FALSE(has_enough([](mcap::Op op, const std::string& record) {
    constexpr std::size_t kHead = 9, kBeforeCounts = 42;
    if (op != mcap::Op::statistics) return record;
    return RawMcap::record(static_cast<std::uint8_t>(op),
                           record.substr(kHead, kBeforeCounts) + RawMcap::number(0U));
  })) << "no counts by channel";
}

TEST(Summary, ThatNamesOneMetadataAgainAndAgainIsNotBelieved) {
  constexpr int kTimes = 100;
  const RecordingFile file{"summary"};
  {
    McapWriter writer{file.path(), {.chain = false}};
    write_all_but_the_end(writer, 20);
    writer.add(McapMetadata{.name = "long", .values = {{"text", std::string(100'000, 'x')}}});
    writer.close();
  }
  const auto repeated = [](int times) {
    return [times](mcap::Op op, const std::string& record) {
      std::string records = record;
      for (int i = 1; i < times && op == mcap::Op::metadata_index; ++i) records += record;
      return records;
    };
  };
  const std::string whole = file.bytes();
  file.replace(with_summary(whole, repeated(1)));
  ASSERT_TRUE(read_summary(file.path()));
  file.replace(with_summary(whole, repeated(kTimes)));
  EXPECT_FALSE(read_summary(file.path())) << "it would take a hundred times the memory";
}

TEST(Summary, ThatTellsAChannelOrASchemaTwiceOtherwiseIsNotBelieved) {
  const RecordingFile file{"summary"};
  {
    McapWriter writer{file.path(), {.chain = false}};
    write_all_but_the_end(writer, 20);
    writer.close();
  }
  const std::string whole = file.bytes();
  const auto is_believed = [&](mcap::Op told_again, std::string_view word, const char* instead) {
    file.replace(with_summary(whole, [&](mcap::Op op, const std::string& record) {
      if (op != told_again) return record;
      std::string again = record;
      again.replace(again.find(word), word.size(), instead);
      return record + again;
    }));
    return read_summary(file.path()).has_value();
  };
  EXPECT_TRUE(is_believed(mcap::Op::channel, "cdr", "cdr")) << "twice alike";
  EXPECT_FALSE(is_believed(mcap::Op::channel, "cdr", "xml"));
  EXPECT_TRUE(is_believed(mcap::Op::schema, "string data", "string data")) << "twice alike";
  EXPECT_FALSE(is_believed(mcap::Op::schema, "string data", "int8[] data"));
}

TEST(Summary, IsNotBelievedWhenAByteOfItIsChangedOrMissing) {
  const RecordingFile file{"summary"};
  McapWriter writer{file.path(), {.chunk_bytes = 2048}};
  write_all_but_the_end(writer, 20);
  writer.close();
  const std::string whole = file.bytes();
  ASSERT_TRUE(read_summary(file.path()));
  constexpr std::size_t kDataEndBytes = 13;
  const std::size_t begin = places_of(mcap::Op::data_end, whole).front() + kDataEndBytes;
  for (std::size_t at = begin; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] ^= 0x01;
    file.replace(changed);
    ASSERT_FALSE(read_summary(file.path())) << "byte " << at;
    file.replace(whole.substr(0, at));
    ASSERT_FALSE(read_summary(file.path())) << "cut at byte " << at;
  }
}

}  // namespace
}  // namespace armature
