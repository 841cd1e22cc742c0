// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What the bus needs to know of a message type, without knowing it: name, layout, life, encoding.
/// One constant per type; it lives in the shared library of the type, which stays loaded.
struct MessageType {
  std::string_view ros_name;  // "sensor_msgs/JointState", as plugin.yaml says it
  std::string_view dds_name;  // "sensor_msgs::msg::dds_::JointState_"
  std::uint64_t layout = 0;   // FNV-1a of the flattened field list; equal only for equal layouts
  void* (*create)() = nullptr;
  void (*destroy)(void* message) = nullptr;
  /// header.stamp, or nullptr for types without a header.
  Time (*stamp)(const void* message) = nullptr;
  /// How many bytes the CDR encoding (little endian, with its 4-byte encapsulation header) needs.
  std::size_t (*encoded_size)(const void* message) = nullptr;
  /// Writes the encoding to the begin of `cdr`, which has at least encoded_size() bytes. Returns
  /// how many it has: fewer than that when a text in it ends early, at a zero.
  std::size_t (*encode_into)(const void* message, std::span<std::byte> cdr) = nullptr;
  /// False when `cdr` is not an encoding of this type.
  bool (*decode)(std::span<const std::byte> cdr, void* message) = nullptr;

  /// Appends the encoding to `cdr`.
  void encode(const void* message, std::vector<std::byte>& cdr) const {
    const std::size_t start = cdr.size();
    cdr.resize(start + encoded_size(message));
    cdr.resize(start + encode_into(message, std::span{cdr}.subspan(start)));
  }
};

/// Defined in the library of the type. The layout is part of the symbol's name: what was compiled
/// for another layout finds no such symbol and cannot be loaded.
template <class Message, std::uint64_t layout>
const MessageType& defined_message();

/// The type's constant.
template <class Message>
const MessageType& message_type() {
  return defined_message<Message, Message::kLayout>();
}

/// All types of the libraries that are loaded, and one by its ROS name or DDS name (nullptr:
/// unknown).
std::vector<const MessageType*> known_message_types();
const MessageType* find_message_type(std::string_view name);

}  // namespace armature
