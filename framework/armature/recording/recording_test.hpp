// SPDX-License-Identifier: Apache-2.0
// For the tests: a small recording, and what is done to it.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "armature/recording/mcap_writer.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {

inline std::string payload(int i) { return "message " + std::to_string(i) + std::string(100, 'x'); }

/// Two channels, an attachment between chunks, and metadata behind them.
inline void write_all_but_the_end(McapWriter& writer, int messages) {
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  const auto a = writer.add(McapChannel{
      .schema_id = schema, .topic = "/a", .message_encoding = "cdr", .metadata = {{"k", "v"}}});
  writer.attach({.name = "lamp.yaml", .media_type = "application/yaml", .data = "armature: 1\n"});
  const auto b =
      writer.add(McapChannel{.schema_id = schema, .topic = "/b", .message_encoding = "cdr"});
  for (int i = 0; i < messages; ++i) {
    const std::string text = payload(i);
    writer.write(i % 3 == 0 ? b : a, static_cast<std::uint32_t>(i), Time{1000 + i}, Time{i},
                 std::as_bytes(std::span{text}));
  }
  writer.add(McapMetadata{.name = "run", .values = {{"seed", "1"}}});
}

/// A file of this test, gone with it.
class RecordingFile {
 public:
  explicit RecordingFile(const std::string& name) : path_{folder_ / (name + ".mcap")} {}

  const std::filesystem::path& path() const { return path_; }
  std::string bytes() const { return content_of(path_); }
  void replace(const std::string& bytes) const {
    std::filesystem::remove(path_);  // one that is emptied and written goes to the disk at once
    std::ofstream{path_, std::ios::binary} << bytes;
  }

 private:
  const TemporaryFolder folder_;
  const std::filesystem::path path_;
};

/// No file of this process grows longer while it exists.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

/// Where the records of that kind begin in a file, chunks not looked into.
inline std::vector<std::size_t> places_of(mcap::Op op, const std::string& bytes) {
  std::vector<std::size_t> places;
  for (std::size_t at = mcap::kMagic.size(); at + 9 < bytes.size();) {
    if (static_cast<mcap::Op>(bytes[at]) == op) places.push_back(at);
    std::uint64_t size = 0;
    std::memcpy(&size, &bytes[at + 1], sizeof size);
    at += 9 + size;
  }
  return places;
}

/// A seed that is shown when the test fails.
class Seed {
 public:
  Seed() : seed_{std::random_device{}()}, trace_{__FILE__, __LINE__, text()} {}
  std::mt19937 generator() const { return std::mt19937{seed_}; }

 private:
  std::string text() const { return "seed " + std::to_string(seed_); }
  unsigned seed_;
  testing::ScopedTrace trace_;
};

/// MCAP as it may be written by a program that is wrong.
class RawMcap {
 public:
  static constexpr std::uint8_t kHeader = 1, kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5,
                                kChunk = 6, kMetadata = 12, kDataEnd = 15;

  template <class Number>
  static std::string number(Number number) {
    static_assert(std::is_integral_v<Number>);
    return {reinterpret_cast<const char*>(&number), sizeof number};
  }
  static std::string text(const std::string& text) {
    return number(static_cast<std::uint32_t>(text.size())) + text;
  }
  static std::string record(std::uint8_t op, const std::string& body) {
    return number(op) + number(std::uint64_t{body.size()}) + body;
  }
  static std::string schema(std::uint16_t id) {
    return record(kSchema, number(id) + text("a/msg/B") + text("ros2msg") + text("bool data"));
  }
  static std::string channel(std::uint16_t id, std::uint16_t schema, const std::string& map,
                             const std::string& topic = "/b") {
    return record(kChannel, number(id) + number(schema) + text(topic) + text("cdr") + map);
  }
  static std::string message(std::uint16_t channel, std::uint64_t log_time) {
    return record(kMessage, number(channel) + number(std::uint32_t{1}) + number(log_time) +
                                number(std::uint64_t{0}) + "data");
  }
  static std::string chunk(std::uint64_t first, std::uint64_t last, const std::string& records) {
    return record(kChunk, number(first) + number(last) + number(std::uint64_t{records.size()}) +
                              number(std::uint32_t{0}) + text("") +
                              number(std::uint64_t{records.size()}) + records);
  }
  /// A whole file of these records; without a summary.
  static std::string file(const std::string& records) {
    const std::string magic{mcap::kMagic};
    return magic + record(kHeader, text("") + text("test")) + records +
           record(kDataEnd, number(std::uint32_t{0})) +
           record(kFooter,
                  number(std::uint64_t{0}) + number(std::uint64_t{0}) + number(std::uint32_t{0})) +
           magic;
  }
};

}  // namespace armature
