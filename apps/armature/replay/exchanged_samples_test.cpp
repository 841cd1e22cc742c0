// SPDX-License-Identifier: Apache-2.0
// Two processes in one file: 'vision' writes /face, and 'main' has recorded what it read of it.
#include "replay/exchanged_samples.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "armature/recording/recording_test.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {
namespace {

class ExchangedSamplesTest : public testing::Test {
 protected:
  /// `numbers` of those that were read, as their writer gave them; none: they are not told. It
  /// numbered what it wrote from 1 on.
  ExchangedSamples compare(const std::vector<int>& written, const std::vector<int>& read,
                           const std::vector<std::uint32_t>& numbers = {},
                           const std::vector<int>& written_by_another = {}) {
    McapWriter writer{file_.path(), {}};
    for (const char* process : {"main", "vision"}) {
      writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
    }
    const auto channel = [&](std::map<std::string, std::string> metadata) {
      return writer.add(
          McapChannel{.topic = "/face", .message_encoding = "", .metadata = std::move(metadata)});
    };
    const auto original = channel({{"process", "vision"}, {"writer", "4096"}});
    std::map<std::string, std::string> of_copy{
        {"process", "main"}, {"writer", "2147483648"}, {"from", "vision"}};
    if (!numbers.empty()) of_copy[kNumberedKey] = "by its writer";
    const auto copy = channel(of_copy);
    int at = 0;
    const auto write = [&](std::uint16_t to, int content, std::uint32_t number) {
      const std::string text = payload(content);
      const Time time{1'000'000 * ++at};
      writer.write(to, number, time, time, std::as_bytes(std::span{text}));
    };
    for (std::size_t i = 0; i < read.size(); ++i) {  // also before it was written
      write(copy, read[i], numbers.empty() ? static_cast<std::uint32_t>(i + 1) : numbers.at(i));
    }
    for (std::uint32_t i = 0; i < written.size(); ++i) write(original, written[i], i + 1);
    if (!written_by_another.empty()) {
      const auto another = channel({{"process", "vision"}, {"writer", "4097"}});
      for (std::uint32_t i = 0; i < written_by_another.size(); ++i) {
        write(another, written_by_another[i], i + 1);
      }
    }
    writer.close();
    return compare_exchanged(file_.path());
  }

  RecordingFile file_{"exchanged"};
};

TEST_F(ExchangedSamplesTest, AreThoseThatWereWrittenSomeOfThemInTheirOrder) {
  const ExchangedSamples exchanged = compare({1, 2, 2, 3, 4}, {1, 2, 2, 4});
  EXPECT_EQ(exchanged.compared, 4U);
  EXPECT_EQ(exchanged.unwritten, 0U);
}

TEST_F(ExchangedSamplesTest, OneThatIsOtherThanWrittenIsNamed) {
  const ExchangedSamples exchanged = compare({1, 2, 3}, {1, 7, 3});
  EXPECT_EQ(exchanged.compared, 2U);
  EXPECT_EQ(exchanged.unwritten, 1U);
  ASSERT_TRUE(exchanged.first);
  EXPECT_EQ(exchanged.first->topic, "/face");
  EXPECT_EQ(exchanged.first->reader, "main");
  EXPECT_DOUBLE_EQ(exchanged.first->at_s, 0.001);
}

TEST_F(ExchangedSamplesTest, OneThatComesTwiceOrTooLateIsNotAsItWasWritten) {
  EXPECT_EQ(compare({1, 2, 3}, {1, 2, 2, 3}).unwritten, 1U) << "twice";
  EXPECT_EQ(compare({1, 2, 3}, {1, 3, 2}).unwritten, 1U) << "out of order";
}

TEST_F(ExchangedSamplesTest, AreKnownByTheNumbersThatTheirWriterGaveAlsoWhenAllAreAlike) {
  const ExchangedSamples some = compare({5, 5, 5, 6}, {5, 5, 6}, {1, 3, 4});
  EXPECT_EQ(some.compared, 3U);
  EXPECT_EQ(some.numbered, 3U);
  EXPECT_EQ(some.unwritten, 0U);
  EXPECT_EQ(compare({5, 5, 5}, {5, 5}, {2, 2}).unwritten, 1U) << "twice";
  EXPECT_EQ(compare({5, 6, 5}, {5}, {2}).unwritten, 1U) << "another one's number";
  EXPECT_EQ(compare({5, 5}, {5}, {3}).unwritten, 1U) << "a number that was not written";
}

TEST_F(ExchangedSamplesTest, AreInTheirOrderAlsoWhereAnotherComponentWasShownTheNewestFirst) {
  const ExchangedSamples some = compare({5, 6, 7}, {7, 5, 6}, {3, 1, 2});
  EXPECT_EQ(some.compared, 3U);
  EXPECT_EQ(some.unwritten, 0U);
}

TEST_F(ExchangedSamplesTest, OfSeveralWritersAreAsOftenAsAnyOfThemWroteThem) {
  // Two write 1 2 3 and 3 1 2; which of them a copy is from nobody tells.
  EXPECT_EQ(compare({1, 2, 3}, {3, 1, 1, 2, 3, 2}, {}, {3, 1, 2}).unwritten, 0U);
  EXPECT_EQ(compare({1, 2, 3}, {3, 1, 1, 2, 1, 2}, {}, {3, 1, 2}).unwritten, 1U) << "one too many";
}

TEST_F(ExchangedSamplesTest, TopicsOfWhichTheWriterRecordedNothingAreLeftOut) {
  const ExchangedSamples exchanged = compare({}, {1, 2});
  EXPECT_EQ(exchanged.compared + exchanged.unwritten, 0U);
}

}  // namespace
}  // namespace armature
