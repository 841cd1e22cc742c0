// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_queue.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kType = "std_msgs::msg::dds_::Bool_";

class McapQueueTest : public ::testing::Test {
 protected:
  static void write(McapQueue& queue, std::uint16_t channel, double at_s) {
    queue.write(channel, 1, Time{} + seconds(at_s), Time{} + seconds(at_s),
                std::vector<std::byte>(5));
  }
  /// Of its messages [s].
  static std::vector<std::int64_t> times_in(const fs::path& file) {
    McapReader reader{file};
    std::vector<std::int64_t> times;
    while (const auto message = reader.next())
      times.push_back(message->log_time.ns / 1'000'000'000);
    EXPECT_THAT(reader.problems(), testing::IsEmpty());
    return times;
  }
  /// When they were sent [s].
  static std::vector<std::int64_t> sent_in(const fs::path& file) {
    McapReader reader{file};
    std::vector<std::int64_t> times;
    while (const auto message = reader.next())
      times.push_back(message->publish_time.ns / 1'000'000'000);
    return times;
  }
  McapQueue::Around around(double around_s) {
    return {.before_and_after = seconds(around_s),
            .file =
                [this](Time moment) {
                  return folder_ / (std::to_string(moment.ns / 1'000'000'000) + ".mcap");
                },
            .told = [this](const fs::path& file) { told_.push_back(file.filename()); }};
  }

  const TemporaryFolder folder_;
  std::vector<std::string> told_;
};

TEST_F(McapQueueTest, WritesChannelsAndMessagesInTheirOrder) {
  McapQueue queue{folder_ / "a.mcap", {}, McapQueue::WhenFull::wait};
  const auto first = queue.add_channel("/a", kType);
  const auto second = queue.add_channel("/b", kType);
  EXPECT_NE(first, second);
  for (int i = 0; i < 1000; ++i) write(queue, i % 2 == 0 ? first : second, i);
  queue.close();
  EXPECT_EQ(queue.messages(), 1000U);
  const std::vector<std::int64_t> times = times_in(folder_ / "a.mcap");
  ASSERT_EQ(times.size(), 1000U);
  EXPECT_TRUE(std::ranges::is_sorted(times));
}

TEST_F(McapQueueTest, WritesWhatHappenedAroundAMoment) {
  McapQueue queue{around(2), {}};
  const auto channel = queue.add_channel("/a", kType);
  for (int i = 0; i < 20; ++i) {
    write(queue, channel, i);
    if (i == 10) queue.mark(Time{} + seconds(10));
  }
  queue.close();
  EXPECT_THAT(times_in(folder_ / "10.mcap"), ElementsAre(8, 9, 10, 11, 12));
  EXPECT_THAT(told_, ElementsAre("10.mcap"));
}

TEST_F(McapQueueTest, AMomentWithinTheFileOfAnotherMakesItLonger) {
  McapQueue queue{around(2), {}};
  const auto channel = queue.add_channel("/a", kType);
  for (int i = 0; i < 20; ++i) {
    write(queue, channel, i);
    if (i == 5 || i == 6 || i == 15) queue.mark(Time{} + seconds(i));
  }
  queue.close();
  EXPECT_THAT(times_in(folder_ / "5.mcap"), ElementsAre(3, 4, 5, 6, 7, 8));
  EXPECT_THAT(times_in(folder_ / "15.mcap"), ElementsAre(13, 14, 15, 16, 17));
  EXPECT_THAT(told_, ElementsAre("5.mcap", "15.mcap"));
}

TEST_F(McapQueueTest, AnotherMomentOfTheSameNameReplacesNothing) {
  McapQueue::Around same_name = around(2);
  same_name.file = [this](Time) { return folder_ / "fault-2026.mcap"; };
  std::ofstream{folder_ / "fault-2026-3.mcap"} << "of somebody else";
  {
    McapQueue queue{same_name, {}};
    const auto channel = queue.add_channel("/a", kType);
    for (int i = 0; i < 30; ++i) {
      write(queue, channel, i);
      if (i % 10 == 5) queue.mark(Time{} + seconds(i));
    }
    queue.close();
  }
  EXPECT_THAT(told_, ElementsAre("fault-2026.mcap", "fault-2026-2.mcap", "fault-2026-4.mcap"));
  EXPECT_THAT(times_in(folder_ / told_[0]), ElementsAre(3, 4, 5, 6, 7));
  EXPECT_THAT(times_in(folder_ / told_[1]), ElementsAre(13, 14, 15, 16, 17));
  EXPECT_THAT(times_in(folder_ / told_[2]), ElementsAre(23, 24, 25, 26, 27));
  EXPECT_EQ(fs::file_size(folder_ / "fault-2026-3.mcap"), 16U);
}

TEST_F(McapQueueTest, EachFileAroundAMomentHasWhatWasLatchedBefore) {
  McapQueue queue{around(2), {}};
  const auto channel = queue.add_channel("/a", kType);
  const auto plan = queue.add_channel("/plan", kType, {{"qos", "latched"}});
  const auto log = queue.add_channel("/log", kType, {{"qos", "log"}});
  const auto state = queue.add_channel("/state", kType, {{"qos", "state"}});
  write(queue, state, 1);
  for (int i = 0; i < 150; ++i) write(queue, log, 2);
  for (int i = 0; i < 60; ++i) {
    write(queue, channel, i);
    if (i == 3 || i == 5 || i == 21 || i == 22) write(queue, plan, i);
    if (i == 20 || i == 40 || i == 50) queue.mark(Time{} + seconds(i));
  }
  queue.close();
  const auto without_log = [&](const fs::path& file) {
    std::vector<std::int64_t> times = sent_in(folder_ / file);
    EXPECT_EQ(std::erase(times, 2), 100) << file;
    const std::vector<std::int64_t> arrived = times_in(folder_ / file);
    EXPECT_TRUE(std::ranges::is_sorted(arrived)) << file;
    EXPECT_GE(arrived.back() - arrived.front(), 4) << file;
    EXPECT_LE(arrived.back() - arrived.front(), 5) << file;
    return times;
  };
  EXPECT_THAT(without_log("20.mcap"), ElementsAre(5, 18, 19, 20, 21, 21, 22, 22));
  EXPECT_THAT(without_log("40.mcap"), ElementsAre(22, 38, 39, 40, 41, 42));
  EXPECT_THAT(without_log("50.mcap"), ElementsAre(22, 48, 49, 50, 51, 52));
}

TEST_F(McapQueueTest, WithoutAMomentThereIsNoFile) {
  McapQueue queue{around(2), {}};
  write(queue, queue.add_channel("/a", kType), 1);
  queue.close();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(McapQueueTest, TellsWhatItCannotWriteAndTakesNoMore) {
  EXPECT_THROW(McapQueue("/dev/full", {}, McapQueue::WhenFull::wait), std::runtime_error);

  const FileSizeLimit limit{4U << 20};
  McapQueue queue{folder_ / "a.mcap", {.compress = false}, McapQueue::WhenFull::wait};
  const auto channel = queue.add_channel("/a", kType);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{10};
  while (queue.problem().empty() && std::chrono::steady_clock::now() < end) {
    queue.write(channel, 1, {}, {}, std::vector<std::byte>(1U << 20));
  }
  EXPECT_THAT(queue.problem(), HasSubstr("File too large"));
  write(queue, channel, 1);
  EXPECT_THAT(queue.dropped(), testing::IsEmpty()) << "none came too fast";
  EXPECT_THROW(queue.close(), std::runtime_error);
  EXPECT_EQ(queue.messages(), 3U) << "a fourth does not fit into 4 MB with all that is around it";
  McapReader reader{folder_ / "a.mcap"};
  std::uint64_t readable = 0;
  while (reader.next()) ++readable;
  EXPECT_EQ(readable, queue.messages());
}

TEST_F(McapQueueTest, WhoseFileIsRemovedMovedOrReplacedSaysSoWithinASecondAndClosesNone) {
  const fs::path folder = folder_ / "runs", file = folder / "a.mcap";
  const std::vector<std::function<void()>> losses{
      [&] { fs::remove(file); }, [&] { fs::remove_all(folder); },
      [&] { fs::rename(folder, folder_ / "elsewhere"); },
      [&] {
        std::ofstream{folder / "b.mcap"} << "of somebody else";
        fs::rename(folder / "b.mcap", file);
      }};
  for (const bool goes_on : {true, false}) {
    for (const auto& lose : losses) {
      fs::remove_all(folder);
      fs::remove_all(folder_ / "elsewhere");
      fs::create_directory(folder);
      McapQueue queue{file, {}, McapQueue::WhenFull::wait};
      write(queue, queue.add_channel("/a", kType), 1);
      EXPECT_TRUE(queue.has_its_file());
      lose();
      EXPECT_FALSE(queue.has_its_file());
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{20};
      while (goes_on && queue.problem().empty() && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
      }
      EXPECT_THAT([&] { queue.close(); },
                  testing::ThrowsMessage<std::runtime_error>(
                      HasSubstr("a.mcap' was removed, moved or replaced while it was recorded")));
      EXPECT_EQ(queue.messages(), 0U) << "nothing of it stands in the file of that name";
    }
  }
}

TEST_F(McapQueueTest, OfAFileWithoutAWholeChunkItCountsNoMessage) {
  const FileSizeLimit limit{4096};
  McapQueue queue{folder_ / "a.mcap", {.compress = false}, McapQueue::WhenFull::wait};
  queue.write(queue.add_channel("/a", kType), 1, {}, {}, std::vector<std::byte>(1U << 20));
  EXPECT_THROW(queue.close(), std::runtime_error);
  EXPECT_EQ(queue.messages(), 0U);
}

}  // namespace
}  // namespace armature
