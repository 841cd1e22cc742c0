// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

// The parts of an MCAP file, by the format's own words. Source: mcap.dev/spec, version 0.

/// What messages of one type look like.
struct McapSchema {
  std::uint16_t id = 0;
  std::string name;      // "sensor_msgs/msg/JointState"
  std::string encoding;  // "ros2msg"
  std::string data;

  bool operator==(const McapSchema&) const = default;
};

/// Messages of one topic.
struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic;             // "/dental_lamp/arm/measured_js"
  std::string message_encoding;  // "cdr"
  std::map<std::string, std::string> metadata;

  bool operator==(const McapChannel&) const = default;
};

/// A file inside the file.
struct McapAttachment {
  Time log_time, create_time;
  std::string name, media_type, data;
};

struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> values;
};

namespace mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

inline bool begins_with_magic(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() &&
         std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F
};

}  // namespace mcap

}  // namespace armature
