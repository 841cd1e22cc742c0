// SPDX-License-Identifier: Apache-2.0
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/cdr_check.hpp"
#include "armature/messages/diagnostic_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/rosgraph_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/messages/tf2_msgs.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/messages/type_description.hpp"
#include "armature/messages/visualization_msgs.hpp"

namespace armature {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

enum MessageIndex : std::size_t {
#define ARMATURE_INDEX(package, Name) package##_##Name,
  ARMATURE_MESSAGES(ARMATURE_INDEX)
#undef ARMATURE_INDEX
      message_count
};

template <class Message>
void encode(const void* message, std::vector<std::byte>& cdr) {
  const auto& typed = *static_cast<const Message*>(message);
  const std::size_t start = cdr.size();
  cdr.resize(start + 4 + Message::getCdrSerializedSize(typed));
  FastBuffer buffer{reinterpret_cast<char*>(cdr.data() + start), cdr.size() - start};
  Cdr encoder{buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
  encoder.serialize_encapsulation();
  typed.serialize(encoder);
  cdr.resize(start + encoder.getSerializedDataLength());
}

template <class Message>
bool decode(std::span<const std::byte> cdr, void* message) {
  // fastcdr trusts the lengths of nested sequences: check them before it allocates.
  static const TypeDescription& description = *describe_type(message_type<Message>().dds_name);
  if (!check_cdr(description, cdr)) return false;
  try {
    // FastBuffer wants a mutable pointer; decoding only reads.
    FastBuffer buffer{reinterpret_cast<char*>(const_cast<std::byte*>(cdr.data())), cdr.size()};
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

template <class Message>
MessageType describe_message(std::string_view ros_name, std::string_view dds_name) {
  const TypeDescription* description = describe_type(dds_name);
  if (!description) throw std::logic_error{"no IDL for " + std::string{dds_name}};
  MessageType type;
  type.ros_name = ros_name;
  type.dds_name = dds_name;
  type.layout = layout_hash(*description);
  type.create = []() -> void* { return new Message; };
  type.destroy = [](void* message) { delete static_cast<Message*>(message); };
  if constexpr (requires(const Message& m) { m.header_(); }) type.stamp = &header_stamp<Message>;
  type.encode = &encode<Message>;
  type.decode = &decode<Message>;
  return type;
}

using Registry = std::array<MessageType, message_count>;

const Registry& registry() {
  static const Registry types{
#define ARMATURE_ENTRY(package, Name) \
  describe_message<msg::Name>(#package "/" #Name, #package "::msg::dds_::" #Name "_"),
      ARMATURE_MESSAGES(ARMATURE_ENTRY)
#undef ARMATURE_ENTRY
  };
  return types;
}

}  // namespace

#define ARMATURE_DEFINE(package, Name)           \
  template <>                                    \
  const MessageType& message_type<msg::Name>() { \
    return registry()[package##_##Name];         \
  }
ARMATURE_MESSAGES(ARMATURE_DEFINE)
#undef ARMATURE_DEFINE

std::span<const MessageType* const> known_message_types() {
  static const auto pointers = [] {
    std::array<const MessageType*, message_count> made{};
    for (std::size_t i = 0; i < message_count; ++i) made[i] = &registry()[i];
    return made;
  }();
  return pointers;
}

const MessageType* find_message_type(std::string_view name) {
  for (const MessageType* type : known_message_types()) {
    if (type->ros_name == name || type->dds_name == name) return type;
  }
  return nullptr;
}

}  // namespace armature
