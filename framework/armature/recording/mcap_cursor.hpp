// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "armature/recording/mcap.hpp"

namespace armature {

/// Reads the parts of a record. Past its end it reads zeros and remembers that it failed.
class McapCursor {
 public:
  explicit McapCursor(std::span<const std::byte> bytes) : left_{bytes} {}

  bool ok() const { return ok_; }
  std::span<const std::byte> left() const { return left_; }
  std::span<const std::byte> take(std::uint64_t size) {
    ok_ = ok_ && size <= left_.size();
    if (!ok_) return {};
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  template <class Number>
  Number number() {
    Number number{};
    if (const auto bytes = take(sizeof number); ok_) {
      std::memcpy(&number, bytes.data(), sizeof number);
    }
    return number;
  }
  std::string text() { return text_of(take(number<std::uint32_t>())); }
  std::string long_text() { return text_of(take(number<std::uint64_t>())); }
  std::map<std::string, std::string> map() {
    std::map<std::string, std::string> map;
    McapCursor inside{take(number<std::uint32_t>())};
    while (inside.ok() && !inside.left().empty()) {
      std::string key = inside.text();
      map[std::move(key)] = inside.text();
    }
    ok_ = ok_ && inside.ok();
    return map;
  }
  Time time() { return Time{number<std::int64_t>()}; }

 private:
  static std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  std::span<const std::byte> left_;
  bool ok_ = true;
};

/// The next record of `bytes`.
struct McapRecord {
  mcap::Op op{};
  McapCursor body{{}};
  std::uint64_t size = 0;  // [byte] with op and length; 0: it is longer than what there is
};

inline McapRecord next_record(std::span<const std::byte> bytes) {
  McapCursor cursor{bytes};
  McapRecord record;
  record.op = static_cast<mcap::Op>(cursor.number<std::uint8_t>());
  record.body = McapCursor{cursor.take(cursor.number<std::uint64_t>())};
  record.size = cursor.ok() ? bytes.size() - cursor.left().size() : 0;
  return record;
}

inline McapSchema read_schema(McapCursor& record) {
  McapSchema schema{.id = record.number<std::uint16_t>()};
  schema.name = record.text();
  schema.encoding = record.text();
  schema.data = record.text();
  return schema;
}

inline McapChannel read_channel(McapCursor& record) {
  McapChannel channel{.id = record.number<std::uint16_t>(),
                      .schema_id = record.number<std::uint16_t>()};
  channel.topic = record.text();
  channel.message_encoding = record.text();
  channel.metadata = record.map();
  return channel;
}

}  // namespace armature
