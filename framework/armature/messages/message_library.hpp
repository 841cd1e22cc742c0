// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/messages/builtin_interfaces.hpp"
#include "armature/messages/cdr_check.hpp"
#include "armature/messages/cdr_size.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/message_type.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/messages/type_description.hpp"

// What the code that armature-messages writes is made of.

namespace armature ARMATURE_EXPORT {

/// The types of one shared library; made when it is loaded.
class MessageLibrary {
 public:
  using Get = const MessageType& (*)();

  /// Describes the types of `idl`.
  explicit MessageLibrary(const char* idl);
  /// From then on find_message_type() finds them. False when types of these names were described
  /// otherwise before: then they are not found.
  bool make_known(const std::vector<Get>& types) const;
  /// Throws std::logic_error when another library defines the type otherwise.
  template <class Message>
  MessageType define(std::string_view dds_name) const;

 private:
  const TypeDescription& description(std::string_view dds_name) const;

  std::string refused_;  // why the types are not described
};

namespace detail {

template <class Message>
std::size_t encoded_size(const void* message) {
  constexpr std::size_t kHeader = 4;
  CdrSize size;
  static_cast<const Message*>(message)->serialize(size);
  return kHeader + size.bytes();
}

template <class Message>
std::size_t encode_into(const void* message, std::span<std::byte> cdr) {
  using eprosima::fastcdr::Cdr;
  eprosima::fastcdr::FastBuffer buffer{reinterpret_cast<char*>(cdr.data()), cdr.size()};
  Cdr encoder{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  encoder.serialize_encapsulation();
  static_cast<const Message*>(message)->serialize(encoder);
  return encoder.getSerializedDataLength();
}

/// Of bytes that passed check_cdr: fastcdr trusts the lengths of nested sequences.
template <class Message>
bool decode(std::span<const std::byte> cdr, void* message) {
  using eprosima::fastcdr::Cdr;
  static const TypeDescription& description = *describe_type(message_type<Message>().dds_name);
  if (!check_cdr(description, cdr)) return false;
  try {
    // FastBuffer wants a mutable pointer; decoding only reads.
    eprosima::fastcdr::FastBuffer buffer{
        reinterpret_cast<char*>(const_cast<std::byte*>(cdr.data())), cdr.size()};
    Cdr decoder{buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR};
    decoder.read_encapsulation();
    static_cast<Message*>(message)->deserialize(decoder);
    return true;
  } catch (const eprosima::fastcdr::exception::Exception&) {
    return false;  // a boolean that is neither 0 nor 1
  }
}

template <class Message>
Time header_stamp(const void* message) {
  return stamp_of(static_cast<const Message*>(message)->header_().stamp_());
}

}  // namespace detail

template <class Message>
MessageType MessageLibrary::define(std::string_view dds_name) const {
  const TypeDescription& described = description(dds_name);
  MessageType type;
  type.ros_name = described.ros_name;
  type.dds_name = described.dds_name;
  type.layout = Message::kLayout;
  type.create = []() -> void* { return new Message; };
  type.destroy = [](void* message) { delete static_cast<Message*>(message); };
  if constexpr (requires(const Message& m) { stamp_of(m.header_().stamp_()); }) {
    type.stamp = &detail::header_stamp<Message>;
  }
  type.encoded_size = &detail::encoded_size<Message>;
  type.encode_into = &detail::encode_into<Message>;
  type.decode = &detail::decode<Message>;
  return type;
}

}  // namespace armature
