// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_queue.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
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

/// The end of a pipe that is read only when it is told to.
class SlowReader {
 public:
  explicit SlowReader(const fs::path& pipe) {
    EXPECT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    descriptor_ = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_GE(descriptor_, 0);
  }
  ~SlowReader() { ::close(descriptor_); }
  SlowReader(const SlowReader&) = delete;
  SlowReader& operator=(const SlowReader&) = delete;

  /// Reads what is there; the end of all that came is kept.
  std::size_t read() {
    constexpr std::size_t kKept = 1U << 20;
    std::vector<char> part(kKept);
    const ssize_t bytes = ::read(descriptor_, part.data(), part.size());
    if (bytes <= 0) return 0;
    last_.append(part.data(), static_cast<std::size_t>(bytes));
    if (last_.size() > 2 * kKept) last_.erase(0, last_.size() - kKept);
    return static_cast<std::size_t>(bytes);
  }
  const std::string& last() const { return last_; }
  /// How much can be read [byte].
  int waiting() const {
    int bytes = 0;
    EXPECT_EQ(ioctl(descriptor_, FIONREAD, &bytes), 0);
    return bytes;
  }

 private:
  int descriptor_ = -1;
  std::string last_;
};

/// Ends a queue into a pipe that is read meanwhile.
void close_to(SlowReader& reader, McapQueue& queue) {
  std::atomic<bool> closed{false};
  std::thread closing{[&] {
    queue.close();
    closed = true;
  }};
  for (bool is_end = false; !is_end;) {
    const bool was_closed = closed;
    is_end = reader.read() == 0 && was_closed;
  }
  closing.join();
}

TEST_F(McapQueueTest, SmallMessagesTakeNoMoreMemoryThanLargeOnes) {
  const fs::path pipe = folder_ / "pipe.mcap";
  SlowReader reader{pipe};
  McapQueue queue{pipe, {.compress = false}, McapQueue::WhenFull::drop};
  const auto channel = queue.add_channel("/a", kType);
  queue.write(channel, 1, {}, {}, std::vector<std::byte>(1U << 20));
  while (reader.waiting() < 20'000) std::this_thread::yield();
  constexpr std::size_t kOfEach = 100;  // [byte] at least, with what stands around it
  std::size_t waiting = 0;
  for (; waiting <= McapQueue::kMaxWaiting / kOfEach && queue.dropped().empty(); ++waiting) {
    queue.write(channel, 1, {}, {}, std::vector<std::byte>(16));
  }
  EXPECT_LE(waiting, McapQueue::kMaxWaiting / kOfEach);
  close_to(reader, queue);
}

TEST_F(McapQueueTest, WhatIsNoMessageIsWrittenHoweverMuchWaits) {
  constexpr std::size_t kMegabyte = 1U << 20;
  const fs::path pipe = folder_ / "pipe.mcap";
  SlowReader reader{pipe};
  McapQueue queue{pipe, {.compress = false}, McapQueue::WhenFull::drop};
  const auto channel = queue.add_channel("/a", kType);
  const auto write_bytes = [&](std::size_t bytes) {
    queue.write(channel, 1, {}, {}, std::vector<std::byte>(bytes));
  };
  const auto dropped = [&] {
    std::uint64_t all = 0;
    for (const auto& [id, count] : queue.dropped()) all += count;
    return all;
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{20};
  const auto is_time_left = [&] { return std::chrono::steady_clock::now() < end; };
  write_bytes(kMegabyte);
  // Nobody reads: the first one is being written, and the others wait behind it.
  while (reader.waiting() < 20'000 && is_time_left()) std::this_thread::yield();
  while (dropped() == 0) write_bytes(kMegabyte);
  // Once those are being written one more is taken, for which there is no room.
  for (std::uint64_t before = 0; before != dropped() && is_time_left();) {
    reader.read();
    before = dropped();
    write_bytes(8 * kMegabyte);
  }
  queue.add({.name = "what became of it", .values = {{"lost", "many"}}});
  queue.attach({.name = "figures.json", .media_type = "application/json", .data = "{}"});
  close_to(reader, queue);
  EXPECT_THAT(reader.last(), HasSubstr("what became of it"));
  EXPECT_THAT(reader.last(), HasSubstr("figures.json"));
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
