// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace eprosima::fastdds::dds {
class TypeSupport;
}

namespace armature ARMATURE_EXPORT {

/// The sample of every topic as Fast DDS sees it: encoded bytes with their encapsulation header.
struct RawCdr {
  std::vector<std::byte> bytes;
};

/// One type support for all message types. It announces the name only, no type information and no
/// type object: with them other vendors refuse the endpoint.
eprosima::fastdds::dds::TypeSupport make_raw_cdr_type(const std::string& dds_name);

}  // namespace armature
