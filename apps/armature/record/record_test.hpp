// SPDX-License-Identifier: Apache-2.0
// Recordings of processes, and what the verbs print of them.
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "armature/recording/mcap_writer.hpp"
#include "armature/recording/recording_test.hpp"
#include "exit_code.hpp"
#include "record/record.hpp"

namespace armature {

/// A recording as a process leaves it: so many messages, one a millisecond from `first_ms` on.
inline void write_part(const std::filesystem::path& file, const std::string& process, int first_ms,
                       const std::string& run = "1") {
  McapWriter writer{file, {.chunk_bytes = 1024}};
  writer.attach(
      {.name = "lamp/lamp.yaml", .media_type = "application/yaml", .data = "armature: 1"});
  writer.add(McapMetadata{.name = "armature.deployment",
                          .values = {{"deployment", "lamp"}, {"run", run}}});
  writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  const auto channel = writer.add(McapChannel{.schema_id = schema,
                                              .topic = "/a",
                                              .message_encoding = "cdr",
                                              .metadata = {{"process", process}}});
  for (int i = 0; i < 100; ++i) {
    const std::string text = payload(i);
    const Time time{1'000'000 * (first_ms + 2 * i)};
    writer.write(channel, static_cast<std::uint32_t>(i), time, time,
                 std::as_bytes(std::span{text}));
  }
  writer.add(McapMetadata{.name = "armature.end", .values = {{"process", process}}});
  writer.close();
}

/// The text that `info` prints: results and complaints.
inline std::string info_text(const InfoOptions& info, int exit_code) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(describe_recording(info), exit_code);
  const std::string out = testing::internal::GetCapturedStdout();
  return out + testing::internal::GetCapturedStderr();
}

/// The object that `armature info --json` prints.
inline nlohmann::json info_of(const std::filesystem::path& file, bool verify) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(describe_recording({.file = file, .json = true, .verify = verify}), kOk);
  return nlohmann::json::parse(testing::internal::GetCapturedStdout());
}

}  // namespace armature
