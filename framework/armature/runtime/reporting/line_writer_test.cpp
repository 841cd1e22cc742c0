// SPDX-License-Identifier: Apache-2.0
// Lines arrive whole and in order, whoever puts them; a reader who does not read delays nobody.
#include "armature/runtime/reporting/line_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace armature {
namespace {

class LineWriterTest : public testing::Test {
 protected:
  LineWriterTest() {
    EXPECT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0);
    std::signal(SIGPIPE, SIG_IGN);
  }
  ~LineWriterTest() override {
    close_reader();
    close(ends_[1]);
  }
  void close_reader() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  /// The next line; waits for it.
  std::string read_line() {
    std::size_t end = 0;
    while ((end = read_.find('\n')) == std::string::npos) {
      std::array<char, 4096> buffer{};
      const ssize_t size = read(ends_[0], buffer.data(), buffer.size());
      if (size <= 0) return "no line";
      read_.append(buffer.data(), static_cast<std::size_t>(size));
    }
    const std::string line = read_.substr(0, end);
    read_.erase(0, end + 1);
    return line;
  }
  static std::string missing(std::uint64_t count) { return std::to_string(count) + " missing"; }

  std::array<int, 2> ends_{-1, -1};
  std::string read_;
};

TEST_F(LineWriterTest, LinesOfOneThreadArriveInOrderAndLongOnesAreCut) {
  LineWriter lines{ends_[1], missing};
  lines.put("one");
  lines.put("");
  lines.put(std::string(5000, 'x'));
  EXPECT_EQ(read_line(), "one");
  EXPECT_EQ(read_line(), "");
  EXPECT_EQ(read_line(), std::string(1000, 'x'));
}

TEST_F(LineWriterTest, LinesOfSeveralThreadsArriveWhole) {
  LineWriter lines{ends_[1], missing};
  constexpr int kThreads = 4, kEach = 50;  // no more than the queue takes
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, text = std::string(100, static_cast<char>('a' + i))] {
      for (int line = 0; line < kEach; ++line) lines.put(text);
    });
  }
  for (auto& thread : threads) thread.join();
  std::array<int, kThreads> counts{};
  for (int i = 0; i < kThreads * kEach; ++i) {
    const std::string line = read_line();
    ASSERT_EQ(line, std::string(100, line.front()));
    ++counts.at(static_cast<std::size_t>(line.front() - 'a'));
  }
  for (const int count : counts) EXPECT_EQ(count, kEach);
}

TEST_F(LineWriterTest, WithoutAReaderNobodyWaitsAndWhatWasDroppedIsCounted) {
  LineWriter lines{ends_[1], missing};
  const std::string text(900, 'x');
  // More than the pipe and the queue take.
  constexpr std::size_t kPut = 2 * LineWriter::kCapacity + 100;
  for (std::size_t i = 0; i < kPut; ++i) lines.put(text);
  lines.flush(seconds(0.05));
  std::size_t told = 0, arrived = 0;
  while (told + arrived < kPut) {
    const std::string line = read_line();
    if (line == text) {
      ++arrived;
    } else {
      told += std::stoul(line);
    }
  }
  EXPECT_GT(told, 0U);
  EXPECT_GE(arrived, LineWriter::kCapacity);
  EXPECT_FALSE(lines.closed());
}

TEST_F(LineWriterTest, AReaderThatIsGoneIsNoticedAndEndsTheWriting) {
  EXPECT_FALSE(is_reader_gone(ends_[1]));
  LineWriter lines{ends_[1], missing};
  close_reader();
  EXPECT_TRUE(is_reader_gone(ends_[1]));
  lines.put("nobody");
  lines.flush(seconds(60));
  EXPECT_TRUE(lines.closed());
}

TEST_F(LineWriterTest, AFullDiskDropsLinesAndIsNoReaderThatIsGone) {
  const int file = open("/dev/full", O_WRONLY | O_CLOEXEC);
  LineWriter lines{file, missing};
  lines.put("lost");
  lines.flush(seconds(60));
  EXPECT_FALSE(lines.closed());
  dup2(ends_[1], file);  // there is room again
  lines.put("written");
  std::set<std::string> told{read_line(), read_line()};
  EXPECT_EQ(told, (std::set<std::string>{"written", "1 missing"}));
  close(file);
}

TEST_F(LineWriterTest, AFileAndAClosedDescriptorHaveNoReaderToLose) {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  EXPECT_FALSE(is_reader_gone(nowhere));
  close(nowhere);
}

}  // namespace
}  // namespace armature
