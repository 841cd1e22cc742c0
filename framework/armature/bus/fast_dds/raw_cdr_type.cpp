// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/raw_cdr_type.hpp"

#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

namespace armature {
namespace {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

class RawCdrType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit RawCdrType(const std::string& dds_name) {
    setName(dds_name.c_str());
    m_typeSize = 512;  // first size of a payload; it grows to what is sent
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }

  bool serialize(void* data, SerializedPayload_t* payload) override {
    const auto& bytes = static_cast<const RawCdr*>(data)->bytes;
    if (bytes.size() < 4 || bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = bytes[1] == std::byte{1} ? CDR_LE : CDR_BE;
    return true;
  }

  bool deserialize(SerializedPayload_t* payload, void* data) override {
    const auto* begin = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<RawCdr*>(data)->bytes.assign(begin, begin + payload->length);
    return true;
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      return static_cast<std::uint32_t>(static_cast<const RawCdr*>(data)->bytes.size());
    };
  }

  void* createData() override { return new RawCdr; }
  void deleteData(void* data) override { delete static_cast<RawCdr*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

}  // namespace

eprosima::fastdds::dds::TypeSupport make_raw_cdr_type(const std::string& dds_name) {
  return eprosima::fastdds::dds::TypeSupport{new RawCdrType{dds_name}};
}

}  // namespace armature
