// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/message_type.hpp"

namespace eprosima::fastdds::dds {
class TypeSupport;
}

namespace armature ARMATURE_EXPORT {

/// What a writer gives to Fast DDS: a message, which is encoded into the payload itself.
struct OutgoingMessage {
  const MessageType* type;
  const void* message;
};

/// What a reader gives to Fast DDS, to be filled from the payload.
class Incoming {
 public:
  virtual ~Incoming() = default;
  /// The encoding with its encapsulation header, as it came.
  virtual void take(std::span<const std::byte> cdr) = 0;
};

/// Decodes it into a message.
class IncomingMessage final : public Incoming {
 public:
  IncomingMessage(const MessageType& type, void* message) : type_{&type}, message_{message} {}
  void take(std::span<const std::byte> cdr) override { decoded_ = type_->decode(cdr, message_); }
  /// False: what came is no encoding of the type.
  bool decoded() const { return decoded_; }

 private:
  const MessageType* type_;
  void* message_;
  bool decoded_ = false;
};

/// Keeps the bytes.
class IncomingBytes final : public Incoming {
 public:
  void take(std::span<const std::byte> cdr) override { bytes.assign(cdr.begin(), cdr.end()); }

  std::vector<std::byte> bytes;
};

/// One type support for all message types: what is written is an OutgoingMessage, and what is read
/// an Incoming. It announces the name only, no type information and no type object: with them other
/// vendors refuse the endpoint.
eprosima::fastdds::dds::TypeSupport make_cdr_type(const std::string& dds_name);

}  // namespace armature
