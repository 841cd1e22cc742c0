// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/cdr_payload.hpp"

#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

namespace armature {
namespace {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

class CdrType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit CdrType(const std::string& dds_name) {
    setName(dds_name.c_str());
    m_typeSize = 512;  // first size of a payload; it grows to what is sent
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }

  bool serialize(void* data, SerializedPayload_t* payload) override {
    const auto& [type, message] = *static_cast<const OutgoingMessage*>(data);
    const std::span bytes{reinterpret_cast<std::byte*>(payload->data), payload->max_size};
    payload->length = static_cast<std::uint32_t>(type->encode_into(message, bytes));
    payload->encapsulation = CDR_LE;
    return true;
  }

  bool deserialize(SerializedPayload_t* payload, void* data) override {
    static_cast<Incoming*>(data)->take(
        {reinterpret_cast<const std::byte*>(payload->data), payload->length});
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      const auto& [type, message] = *static_cast<const OutgoingMessage*>(data);
      return static_cast<std::uint32_t>(type->encoded_size(message));
    };
  }

  void* createData() override { return static_cast<Incoming*>(new IncomingBytes); }
  void deleteData(void* data) override { delete static_cast<Incoming*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

}  // namespace

eprosima::fastdds::dds::TypeSupport make_cdr_type(const std::string& dds_name) {
  return eprosima::fastdds::dds::TypeSupport{new CdrType{dds_name}};
}

}  // namespace armature
